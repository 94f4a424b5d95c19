// SPDX-License-Identifier: MIT
// A .lode file of this tracer, all numbers little-endian:
//
//   magic "lodestn" and a control character that text editors do not keep, version, kind of content
//   record: content hash (text), scene (text), height scale (float), instancing, the settings that were asked
//   for
//   kind, number of objects, charts, texels, slots, and of faces, points, pieces and texels of the charts'
//   maps
//   the report
//   objects, charts, texel map, leaf map, and the maps of charts: see packed_rows.h
//   checksum: 32 hexadecimal digits over everything before
#include "lodestone/geometry_image/atlas_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "lodestone/base/error.h"
#include "lodestone/base/file.h"
#include "lodestone/base/hash.h"
#include "lodestone/geometry_image/atlas_check.h"
#include "lodestone/geometry_image/byte_stream.h"
#include "lodestone/geometry_image/packed_rows.h"

namespace lodestone::geometry_image {
namespace {

constexpr std::array<char, 8> magic = {'l', 'o', 'd', 'e', 's', 't', 'n', '\x1a'};
constexpr uint32_t version = 7;
constexpr uint32_t content_atlas = 1;
constexpr size_t checksum_digits = 32;

// Nothing that build_atlas makes is larger.
constexpr uint64_t max_slots = uint64_t(1) << (2 * layout::max_depth);
constexpr uint64_t max_charts = max_slots, max_objects = max_slots;
constexpr uint64_t max_texels = (uint64_t(1) << 31) - 1;
constexpr uint64_t max_triangles = uint64_t(1) << 28;
constexpr uint64_t max_map_faces = uint64_t(1) << 30;
constexpr uint32_t longest_text = 4096;
constexpr uint32_t most_notes = 64;

// The numbers of a report, in the order of the file.
constexpr uint64_t AtlasReport::*report_numbers[] = {&AtlasReport::triangles,
                                                     &AtlasReport::quads,
                                                     &AtlasReport::texels,
                                                     &AtlasReport::slots,
                                                     &AtlasReport::degenerate_triangles,
                                                     &AtlasReport::duplicate_triangles,
                                                     &AtlasReport::non_manifold_edges,
                                                     &AtlasReport::boundary_edges,
                                                     &AtlasReport::welded_vertices,
                                                     &AtlasReport::mapped_triangles,
                                                     &AtlasReport::mapped_charts,
                                                     &AtlasReport::repeated_texels};

constexpr double AtlasReport::*report_stretches[] = {&AtlasReport::mean_stretch, &AtlasReport::high_stretch};

std::string checksum(std::span<const std::byte> bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.hex();
}

BakeRecord read_record(ByteReader& reader) {
  BakeRecord record;
  record.content_hash = reader.text(longest_text);
  record.scene = reader.text(longest_text);
  record.height_scale = reader.number<float>();
  if (!std::isfinite(record.height_scale) || record.height_scale < 0)
    reader.fail("its height scale is out of range");
  const auto instancing = reader.number<uint32_t>();
  if (instancing > static_cast<uint32_t>(scene::Instancing::off))
    reader.fail("it was baked with unknown instancing");
  record.instancing = static_cast<scene::Instancing>(instancing);
  const auto asked = reader.number<uint32_t>();
  if (asked > static_cast<uint32_t>(AtlasKind::charts))
    reader.fail("it was baked as an atlas of unknown kind");
  record.asked.kind = static_cast<AtlasKind>(asked);
  record.asked.charts.texel_budget = reader.number<uint64_t>();
  const auto signal = reader.number<uint32_t>(), all_shapes = reader.number<uint32_t>(),
             keep_maps = reader.number<uint32_t>();
  if (signal > static_cast<uint32_t>(Signal::screen) || all_shapes > 1 || keep_maps > 1)
    reader.fail("it was baked for an unknown signal");
  record.asked.charts.signal = static_cast<Signal>(signal);
  record.asked.charts.all_shapes = all_shapes == 1;
  record.asked.charts.keep_maps = keep_maps == 1;
  return record;
}

AtlasReport read_report(ByteReader& reader) {
  AtlasReport report;
  for (uint64_t AtlasReport::*field : report_numbers) report.*field = reader.number<uint64_t>();
  if (report.triangles > max_triangles) reader.fail("it claims too many triangles");
  for (double AtlasReport::*field : report_stretches) {
    report.*field = reader.number<double>();
    if (!std::isfinite(report.*field) || report.*field < 0) reader.fail("its stretch is out of range");
  }
  const auto notes = reader.number<uint32_t>();
  if (notes > most_notes) reader.fail("it claims too many notes");
  for (uint32_t i = 0; i < notes; ++i) {
    report.notes.push_back(reader.text(longest_text));
    // Notes are printed: nothing in them may steer a terminal.
    const std::string& note = report.notes.back();
    if (std::any_of(note.begin(), note.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
      reader.fail("a note is no text");
    }
  }
  return report;
}

uint64_t read_count(ByteReader& reader, uint64_t most) {
  const auto count = reader.number<uint64_t>();
  if (count > most) reader.fail("an array claims too many elements");
  return count;
}

// Takes the checksum off, having compared it, and the start of the header.
std::span<const std::byte> trusted_part(const std::string& file, std::span<const std::byte> bytes) {
  ByteReader head(file, bytes);
  if (bytes.size() < magic.size() ||
      std::memcmp(head.bytes(magic.size()).data(), magic.data(), magic.size()) != 0) {
    fail_input(file, "is not a baked file; make one with `lodestone bake SCENE -o FILE`");
  }
  const auto found_version = head.number<uint32_t>();
  if (found_version != version) {
    fail_input(file, "is a baked file of version {}, and this program reads version {}; bake it again",
               found_version, version);
  }
  if (bytes.size() < magic.size() + 2 * sizeof(uint32_t) + checksum_digits) head.fail("it is cut short");
  const std::span<const std::byte> content = bytes.first(bytes.size() - checksum_digits);
  if (std::memcmp(checksum(content).data(), &bytes[content.size()], checksum_digits) != 0) {
    head.fail("its checksum is wrong");
  }
  if (head.number<uint32_t>() != content_atlas) {
    fail_input(file, "holds no geometry images; bake the scene for this tracer");
  }
  return content.subspan(magic.size() + 2 * sizeof(uint32_t));
}

}  // namespace

std::vector<std::byte> pack_atlas(const Atlas& atlas, const BakeRecord& record) {
  ByteWriter writer;
  writer.bytes(std::as_bytes(std::span(magic)));
  writer.number(version);
  writer.number(content_atlas);
  writer.text(record.content_hash);
  writer.text(record.scene);
  writer.number(record.height_scale);
  writer.number(static_cast<uint32_t>(record.instancing));
  writer.number(static_cast<uint32_t>(record.asked.kind));
  writer.number(record.asked.charts.texel_budget);
  writer.number(static_cast<uint32_t>(record.asked.charts.signal));
  writer.number(static_cast<uint32_t>(record.asked.charts.all_shapes));
  writer.number(static_cast<uint32_t>(record.asked.charts.keep_maps));
  writer.number(static_cast<uint32_t>(atlas.kind));
  writer.number(static_cast<uint64_t>(atlas.objects.size()));
  writer.number(static_cast<uint64_t>(atlas.charts.size()));
  writer.number(static_cast<uint64_t>(atlas.texel_map.size()));
  writer.number(static_cast<uint64_t>(atlas.leaf_map.size()));
  writer.number(static_cast<uint64_t>(atlas.maps.faces.size()));
  writer.number(static_cast<uint64_t>(atlas.maps.points.size()));
  writer.number(static_cast<uint64_t>(atlas.maps.pieces.size()));
  writer.number(static_cast<uint64_t>(atlas.maps.sites.size()));
  for (uint64_t AtlasReport::*field : report_numbers) writer.number(atlas.report.*field);
  for (double AtlasReport::*field : report_stretches) writer.number(atlas.report.*field);
  writer.number(static_cast<uint32_t>(atlas.report.notes.size()));
  for (const std::string& note : atlas.report.notes) writer.text(note);
  pack_rows(atlas.objects, writer);
  pack_rows(atlas.charts, writer);
  pack_rows(atlas.texel_map, writer);
  pack_rows(atlas.leaf_map, writer);
  pack_rows(atlas.maps.faces, writer);
  pack_rows(atlas.maps.points, writer);
  pack_rows(atlas.maps.pieces, writer);
  pack_rows(atlas.maps.sites, writer);
  const std::string sum = checksum(writer.written());
  writer.bytes(std::as_bytes(std::span(sum)));
  return writer.take();
}

Atlas unpack_atlas(const std::string& file, std::span<const std::byte> bytes, BakeRecord* record) {
  ByteReader reader(file, trusted_part(file, bytes));
  const BakeRecord found = read_record(reader);
  Atlas atlas;
  atlas.kind = static_cast<AtlasKind>(reader.number<uint32_t>());
  const uint64_t objects = read_count(reader, max_objects);
  const uint64_t charts = read_count(reader, max_charts);
  const uint64_t texels = read_count(reader, max_texels);
  const uint64_t slots = read_count(reader, max_slots);
  const uint64_t map_faces = read_count(reader, max_map_faces);
  const uint64_t map_points = read_count(reader, max_map_faces);
  const uint64_t map_pieces = read_count(reader, max_map_faces);
  const uint64_t map_texels = read_count(reader, max_texels);
  atlas.report = read_report(reader);
  atlas.objects = unpack_rows<AtlasObject>(reader, objects);
  atlas.charts = unpack_rows<layout::ChartRecord>(reader, charts);
  atlas.texel_map = unpack_rows<glm::uvec4>(reader, texels);
  atlas.leaf_map = unpack_rows<glm::uvec2>(reader, slots);
  atlas.maps.faces = unpack_rows<layout::MapFace>(reader, map_faces);
  atlas.maps.points = unpack_rows<glm::vec2>(reader, map_points);
  atlas.maps.pieces = unpack_rows<layout::MapPiece>(reader, map_pieces);
  atlas.maps.sites = unpack_rows<layout::MapSite>(reader, map_texels);
  if (!reader.at_end()) reader.fail("it goes on behind its end");
  const std::string fault = find_fault(atlas);
  if (!fault.empty()) reader.fail(("it has " + fault).c_str());
  if (record != nullptr) *record = found;
  return atlas;
}

void save_atlas(const std::filesystem::path& path, const Atlas& atlas, const BakeRecord& record) {
  write_file(path, pack_atlas(atlas, record));
}

Atlas load_atlas(const std::filesystem::path& path, BakeRecord* record) {
  return unpack_atlas(path.string(), read_file(path), record);
}

}  // namespace lodestone::geometry_image
