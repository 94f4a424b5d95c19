// SPDX-License-Identifier: MIT
#include "threaded_kernel.h"

#include <bit>

#include "lodestone/layout/objects.h"
#include "lodestone/render/passes.h"
#include "lodestone/render/scene_tables.h"
#include "lodestone/test_support/devices.h"

namespace lodestone::test {
namespace {

using glm::uvec4;

constexpr uint32_t texels_a_triangle = 4, row_stride = 2, loop_budget = 4000;

uvec4 quad(const glm::vec3& v, uint32_t w) {
  return {std::bit_cast<uint32_t>(v.x), std::bit_cast<uint32_t>(v.y), std::bit_cast<uint32_t>(v.z), w};
}

// A quad whose second triangle has no area, so that nothing ever hits it.
std::vector<uvec4> geometry_of(const ThreadedBvh& bvh) {
  std::vector<uvec4> texels;
  for (const Triangle& t : bvh.triangles()) {
    for (const glm::vec3& corner : {t.a, t.b, t.c, t.c}) texels.push_back(quad(corner, 1));
  }
  return texels;
}

}  // namespace

ThreadedKernel::ThreadedKernel(const ThreadedBvh& bvh, const std::string& device,
                               const render::BackendOptions& options)
    : backend_(open(device, options)) {
  std::vector<uvec4> lo, hi;
  std::vector<uint32_t> links;
  const auto end = static_cast<uint32_t>(bvh.nodes().size());
  for (uint32_t i = 0; i < end; ++i) {
    const ThreadedBvh::Node& node = bvh.nodes()[i];
    const bool leaf = node.triangle != no_triangle;
    const uint32_t hit = leaf ? layout::leaf_flag | (texels_a_triangle * node.triangle) : i + 1;
    lo.push_back(quad(node.lo, leaf ? hit : 0));
    hi.push_back(quad(node.hi, leaf ? row_stride : 0));
    links.push_back(hit);
    links.push_back(node.miss == end ? 0 : node.miss);
  }
  geometry_ = render::make_buffer(*backend_, "geometry", 16, geometry_of(bvh));
  nodes_lo_ = render::make_buffer(*backend_, "nodes_lo", 16, lo);
  nodes_hi_ = render::make_buffer(*backend_, "nodes_hi", 16, hi);
  links_ = render::make_buffer(*backend_, "links", 4, links);
  pending_ = render::Buffer(*backend_, {"pending", 1, 4});
  // One object, whose nodes begin at the first.
  objects_ = render::make_buffer(*backend_, "objects", 16, std::vector<layout::ObjectRecord>(1));
}

void ThreadedKernel::load_rays(const Rays& rays) {
  ray_count_ = static_cast<uint32_t>(rays.size() / 2);
  rays_ = render::RayBuffers(*backend_, "", ray_count_);
  backend_->upload(rays_.rays.id(), std::as_bytes(std::span(rays)));
}

void ThreadedKernel::trace() {
  // Without instances, motion, levels of detail and a list of rays the last seven are read by nothing.
  const std::array<render::BufferId, 17> buffers = {
      rays_.rays.id(),  geometry_.id(),   rays_.hits.id(),  rays_.states.id(), rays_.steps.id(),
      pending_.id(),    nodes_lo_.id(),   nodes_hi_.id(),   links_.id(),       objects_.id(),
      rays_.steps.id(), rays_.steps.id(), rays_.steps.id(), geometry_.id(),    geometry_.id(),
      geometry_.id(),   rays_.steps.id()};
  layout::TracePush push{};
  push.rays = ray_count_;
  push.budget = loop_budget;
  for (uint32_t pending = 1; pending != 0; push.resume = 1) {
    pending = 0;
    backend_->upload(pending_.id(), std::as_bytes(std::span(&pending, 1)));
    backend_->run({&render::passes::trace_threaded, buffers, std::as_bytes(std::span(&push, 1)), ray_count_});
    backend_->download(pending_.id(), std::as_writable_bytes(std::span(&pending, 1)));
  }
}

std::vector<TriangleHit> ThreadedKernel::hits() {
  std::vector<uvec4> bits(ray_count_);
  backend_->download(rays_.hits.id(), std::as_writable_bytes(std::span(bits)));
  std::vector<TriangleHit> hits;
  for (const uvec4& hit : bits) {
    hits.push_back({std::bit_cast<float>(hit.x), std::bit_cast<float>(hit.y), std::bit_cast<float>(hit.z),
                    hit.w == layout::no_index ? no_triangle : hit.w / (2 * texels_a_triangle)});
  }
  return hits;
}

render::Counters ThreadedKernel::take_counters() {
  render::Counters sum;
  for (const render::PassRecord& pass : backend_->finish()) {
    sum.rays += pass.counters.rays;
    sum.node_visits += pass.counters.node_visits;
    sum.box_tests += pass.counters.box_tests;
    sum.triangle_tests += pass.counters.triangle_tests;
  }
  return sum;
}

}  // namespace lodestone::test
