// SPDX-License-Identifier: MIT
#include "lodestone/render/tracing.h"

#include "lodestone/base/error.h"
#include "lodestone/layout/frame.h"
#include "lodestone/layout/links.h"
#include "lodestone/layout/trace.h"
#include "lodestone/render/passes.h"

namespace lodestone::render {
namespace {

Traversal choose_traversal(const DeviceInfo& device, Traversal wanted) {
  const bool cpu = device.kind == "cpu";
  if (wanted == Traversal::automatic) return cpu ? Traversal::wide : Traversal::octant;
  if (wanted == Traversal::wide && !cpu) {
    fail(ExitCode::usage, "--traversal wide", "runs on the CPU only; use threaded or octant on this device");
  }
  return wanted;
}

}  // namespace

Tracing::Tracing(Backend& backend, const geometry_image::Atlas& atlas, const Buffer& leaf_map,
                 Traversal traversal, uint32_t loop_budget)
    : backend_(backend),
      leaf_map_(leaf_map),
      traversal_(choose_traversal(backend.info(), traversal)),
      loop_budget_(loop_budget),
      levels_(atlas.depth, static_cast<uint32_t>(atlas.leaf_map.size())),
      nodes_lo_(backend, {"nodes_lo", levels_.nodes(), 16}),
      nodes_hi_(backend, {"nodes_hi", levels_.nodes(), 16}),
      links_(backend, {"links", 2 * levels_.nodes(), 4}),
      pending_(backend, {"pending", 1, 4}) {
  if (traversal_ == Traversal::wide) {
    const WideLevels wide(levels_.depth(), levels_.slots());
    wide_nodes_ = Buffer(backend, {"wide_nodes", wide.end(), wide_node_bytes});
  }
  build_links();
}

template <class Push>
void Tracing::run(const PassDecl& pass, const std::vector<BufferId>& buffers, const Push& push,
                  uint32_t invocations, const std::array<uint32_t, pass_constants>& constants) {
  backend_.run({&pass, buffers, std::as_bytes(std::span(&push, 1)), invocations, constants});
}

void Tracing::build_links() {
  for (uint32_t level = 0; level <= levels_.depth(); ++level) {
    // Only nodes above a slot in use: the siblings behind them are empty and never linked to.
    const uint32_t shift = 2 * (levels_.depth() - level);
    const auto used =
        static_cast<uint32_t>((uint64_t(levels_.slots()) + (uint64_t(1) << shift) - 1) >> shift);
    run(passes::links, {leaf_map_.id(), links_.id()},
        layout::LinksPush{level, levels_.depth(), used, levels_.slots()}, used);
  }
}

void Tracing::build(const Buffer& geometry) {
  const uint32_t depth = levels_.depth();
  run(passes::bounds_leaves, {leaf_map_.id(), geometry.id(), nodes_lo_.id(), nodes_hi_.id()},
      layout::BoundsPush{depth, levels_.slots(), levels_.places(depth), levels_.places(depth - 1)},
      levels_.places(depth - 1));
  for (uint32_t level = depth - 1; level > 0;) {
    const bool two = level >= 2;
    const layout::BoundsPush push{level, levels_.places(level), levels_.places(level - 1),
                                  two ? levels_.places(level - 2) : 0};
    run(passes::bounds, {nodes_lo_.id(), nodes_hi_.id()}, push, two ? push.written_above : push.written);
    level -= two ? 2 : 1;
  }
  if (traversal_ == Traversal::wide) {
    const WideLevels wide(depth, levels_.slots());
    run(passes::wide_nodes, {nodes_lo_.id(), nodes_hi_.id(), wide_nodes_.id()},
        layout::BoundsPush{depth, levels_.slots(), 0, 0}, wide.end());
  }
}

uint32_t Tracing::take_pending() {
  uint32_t count = 0;
  backend_.download(pending_.id(), std::as_writable_bytes(std::span(&count, 1)), 0);
  return count;
}

bool Tracing::trace(const Buffer& geometry, const RayBuffers& rays, uint32_t count, const TraceQuery& query,
                    const Interrupted& interrupted) {
  const PassDecl* closest[] = {nullptr, &passes::trace_threaded, &passes::trace_octant, &passes::trace_wide};
  const PassDecl* shadow[] = {nullptr, &passes::occlude_threaded, &passes::occlude_octant,
                              &passes::occlude_wide};
  const PassDecl& pass = *(query.shadow ? shadow : closest)[static_cast<uint32_t>(traversal_)];
  std::vector<BufferId> buffers = {rays.rays.id(),   nodes_lo_.id(),  nodes_hi_.id(),
                                   geometry.id(),    links_.id(),     rays.hits.id(),
                                   rays.states.id(), rays.steps.id(), pending_.id()};
  if (traversal_ == Traversal::wide) buffers.insert(buffers.end(), {wide_nodes_.id(), leaf_map_.id()});
  const uint32_t zero = 0;
  layout::TracePush push{count, levels_.depth(), take_pending() != 0 ? 1u : 0u, loop_budget_,
                         levels_.slots()};
  do {
    if (interrupted && interrupted()) return false;
    backend_.upload(pending_.id(), std::as_bytes(std::span(&zero, 1)));
    run(pass, buffers, push, count, {query.any_hit ? 1u : 0u, query.steps ? 1u : 0u});
    push.resume = 1;
  } while (take_pending() != 0);
  return true;
}

}  // namespace lodestone::render
