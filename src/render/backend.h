// SPDX-License-Identifier: MIT
// What a frame runs on. A pass is declared once, as data; a back end (host/ for Vulkan, cpu_fallback/ for
// native code) knows how to run a pass of that name over buffers of 32-bit words. Nothing else crosses the
// border.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lodestone::render {

// How a pass sees a buffer. `word` and `quad` buffers (4 and 16 bytes an element) may be of any size: a
// device that has texel buffers of 2^27 elements gets them as storage texel buffers (R32ui, RGBA32ui, and the
// kernel variants `_texel` and `_pairs`), others as storage buffers, and what neither can show is split over
// several buffers (the variant `_split`). `structs` is always one storage buffer.
enum class BindingKind : uint8_t { structs, word, quad };
enum class Access : uint8_t { read, write, read_write };

struct Binding {
  const char* name;
  BindingKind kind;
  Access access;
};

// One kernel. Binding i of descriptor set 0 is bindings[i]. Every kernel has one more binding behind these:
// `counters`, a storage buffer (see layout/counters.h) that the back end owns.
struct PassDecl {
  const char* name;    // as in statistics, labels and traces: "bounds"
  const char* kernel;  // shader and CPU function: "geometry_image/bounds"
  std::span<const Binding> bindings;
  uint32_t push_bytes = 0;  // size of the push-constant block, at most 128
  uint32_t workgroup = 64;  // local size in x: specialization constant 0
};

using BufferId = uint32_t;

struct BufferDesc {
  std::string name;
  uint64_t elements = 0;
  uint32_t element_bytes = 4;  // 4 for word, 16 for quad buffers, the struct's size for others
};

// Specialization constants 0 (workgroup size) and 1 (count: 0 or 1) are set by the back end; `constants[i]`
// is constant 2 + i of every kernel that declares it.
inline constexpr uint32_t pass_constants = 6;

struct Dispatch {
  const PassDecl* pass = nullptr;
  std::span<const BufferId> buffers;  // one a binding
  std::span<const std::byte> push;    // pass->push_bytes bytes
  uint32_t invocations = 0;           // kernels return at once where gl_GlobalInvocationID.x is not below it
  std::array<uint32_t, pass_constants> constants{};
};

// Counted where it happens, in the kernels (layout/counters.h); all zero unless counting is on.
struct Counters {
  uint64_t bytes_read = 0, bytes_written = 0;
  uint64_t rays = 0, node_visits = 0, box_tests = 0, triangle_tests = 0;
  uint64_t lane_steps = 0;  // traversal steps of single lanes ...
  uint64_t subgroup_steps =
      0;  // ... and of whole subgroups times their size: the quotient is the share of active lanes
};

// One dispatch that has finished.
struct PassRecord {
  std::string name;
  double device_ms =
      std::numeric_limits<double>::quiet_NaN();  // timestamps; NaN on the CPU and on a first dispatch
  double wall_start_ms = 0, wall_ms = 0;         // host clock, since the back end was made
  bool first = false;  // the first dispatch of its kernel: the driver may have compiled it meanwhile
  uint64_t invocations = 0;
  bool counted = false;
  Counters counters;
};

struct DeviceInfo {
  std::string kind;  // "gpu" or "cpu"
  std::string name, driver, api;
  uint32_t index = 0;
  uint32_t subgroup_size = 1;
  uint64_t max_buffer_bytes = 0;   // the largest word or quad buffer that is not split
  bool cuts_loops = false;         // an invocation may be stopped after some ten thousand loop iterations
  std::vector<std::string> lacks;  // what the device does not have, one short line each
};

struct BackendOptions {
  bool counters = false;  // count in the kernels
  bool validate = false;  // Vulkan validation layers; any message is an Error(device)
  uint32_t threads = 0;   // CPU threads; 0: all
};

// Not thread-safe. Every call may throw Error(device) (lost, validation message) or Error(machine) (out of
// memory).
class Backend {
 public:
  virtual ~Backend() = default;
  virtual const DeviceInfo& info() const = 0;

  virtual BufferId create(
      const BufferDesc& desc) = 0;  // zero-filled; throws Error(device) where it cannot be that big
  virtual void destroy(BufferId buffer) = 0;
  virtual void upload(BufferId buffer, std::span<const std::byte> bytes, uint64_t offset_bytes = 0) = 0;
  virtual void download(BufferId buffer, std::span<std::byte> bytes, uint64_t offset_bytes = 0) = 0;  // waits
  virtual const BufferDesc& desc(BufferId buffer) const = 0;

  // Runs a pass after everything enqueued before it; barriers follow from the bindings' access.
  virtual void run(const Dispatch& dispatch) = 0;
  // Waits for all passes; returns the records of those finished since the last call, in order.
  virtual std::vector<PassRecord> finish() = 0;
  virtual uint64_t allocated_bytes() const = 0;
};

// One RAII handle.
class Buffer {
 public:
  Buffer() = default;
  Buffer(Backend& backend, const BufferDesc& desc) : backend_(&backend), id_(backend.create(desc)) {}
  Buffer(Buffer&& other) noexcept : backend_(other.backend_), id_(other.id_) { other.backend_ = nullptr; }
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(backend_, other.backend_);
    std::swap(id_, other.id_);
    return *this;
  }
  ~Buffer() {
    if (backend_ != nullptr) backend_->destroy(id_);
  }
  BufferId id() const { return id_; }
  explicit operator bool() const { return backend_ != nullptr; }

 private:
  Backend* backend_ = nullptr;
  BufferId id_ = 0;
};

}  // namespace lodestone::render
