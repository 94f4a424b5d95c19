// SPDX-License-Identifier: MIT
// The frame: which passes run, in what order, on which buffers. Knows a Backend and nothing of Vulkan or
// threads.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/geometry_image/atlas.h"
#include "lodestone/image/image.h"
#include "lodestone/render/backend.h"
#include "lodestone/scene/assembly.h"
#include "lodestone/scene/pose.h"
#include "lodestone/scene/scene.h"

namespace lodestone::render {

// `tile`: primary rays by tiles of 64, on devices with subgroups of 8; all other rays as `wide`. `automatic`
// takes the fastest of the back end.
enum class Traversal : uint32_t { automatic, threaded, octant, wide, tile };
// `eye`: direct light where the camera's rays end; `dof`: the same through a lens of some size. `ao`: ambient
// occlusion there, 1 where nothing is near. Rays go on with `specular` (direct light, and what smooth
// surfaces mirror and let through), `glossy` (the same of rough ones, by a drawn ray) and `path` (all light,
// by path tracing).
enum class Integrator : uint32_t { eye, dof, ao, specular, glossy, path };

// With `specular`.
inline constexpr uint32_t most_specular_bounces = 64;
enum class ViewTransform : uint32_t { filmic, linear };

struct Settings {
  uint32_t width = 512, height = 512;
  uint32_t spp = 1;
  uint32_t seed = 0;
  Integrator integrator = Integrator::eye;
  uint32_t max_bounces = 8;   // surfaces that a ray goes on from, where rays do
  float ao_distance = 1e30f;  // beyond which nothing occludes
  float lens_radius = 0;      // scene units; 0: all is sharp, but with `dof`, which takes a 40th of the focus
  float focus_distance = 0;   // along the view direction; 0: to what is nearest in the picture's middle
  Traversal traversal = Traversal::automatic;
  ViewTransform view = ViewTransform::filmic;
  float exposure = 0;             // stops
  std::vector<std::string> aovs;  // of: depth normal albedo uv id lod steps
  bool denoise = false;           // of at least 2 spp (render/denoiser.h)
  // The whole picture sample by sample (16 bytes a pixel more on the device), so that it can be seen, and
  // stopped, while it gets better. Not with `denoise`.
  bool progressive = false;
  bool noisy = false;           // with `denoise`: also noisy.R G B, the beauty before it
  uint32_t loop_budget = 4000;  // traversal steps of one dispatch; see trace.h
  // Of the texels of mapped charts, every frame, before the hierarchy is built: they go where the pose
  // stretches the surface. Other charts stay as they are.
  uint32_t relaxation_sweeps = 0;
  // Motion blur: the equal stretches of the time that the shutter is open in which everything moves along
  // straight lines (layout/motion.h), at most most_segments; 0: it is open for an instant.
  uint32_t shutter_segments = 0;
  // Levels of detail (layout/detail.h): the error, in pixels, that rays tolerate; 0: none, every quad counts.
  float pixels_of_error = 0;
  // Bytes that may be allocated on the device; where the scene does not fit, portions of it come and go
  // (layout/portion.h). 0: as many as there are.
  uint64_t device_memory = 0;
};

// A camera in the world: rays start at `origin` and go through the image plane origin + forward + x right + y
// up, x and y in [-1, 1] (orthographic: parallel to forward, from origin + x right + y up).
struct View {
  std::string name;
  glm::vec3 origin{0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  bool perspective = true;
};

// `name`: a camera of the scene, a number, or "auto": one that frames `bounds` from the front, a little from
// above. Empty: the first camera of the scene, else auto. Throws Error(usage) listing the cameras.
View find_view(const scene::Scene& scene, const scene::Pose& pose, const std::string& name,
               const scene::Bounds& bounds, uint32_t width, uint32_t height);

// That camera, or one that is put elsewhere.
struct CameraChoice {
  std::string name;  // as above
  // From where `auto` frames the bounds, degrees: from +Z (the front) towards +X, and upwards from the
  // ground.
  std::optional<glm::vec2> orbit;
  std::optional<float> field_of_view;  // from bottom to top, degrees
  // In the world, upright; a camera that is given `from` alone looks at the middle of the bounds.
  std::optional<glm::vec3> from, at;

  bool needs_bounds(const scene::Scene& scene) const;
};
// Throws Error(usage) too where the parts contradict each other.
View find_view(const scene::Scene& scene, const scene::Pose& pose, const CameraChoice& choice,
               const scene::Bounds& bounds, uint32_t width, uint32_t height);

// What the shutter sees at a time.
struct Moment {
  scene::Pose pose;
  View view;
};

// How a scene that is larger than Settings::device_memory was rendered.
struct Streaming {
  uint32_t portions = 0;
  uint64_t loads = 0;       // of a portion onto the device
  uint64_t peak_bytes = 0;  // the most that was allocated there
};

struct FrameResult {
  uint32_t samples = 0;  // that every pixel has got at least; fewer than asked for where it was interrupted
  image::Image linear;   // R G B A and the AOVs, under their EXR channel names
  image::Image display;  // R G B after exposure, view transform and sRGB encoding; the sky behind everything
  std::vector<PassRecord> passes;
  double wall_ms = 0;
};

// Told that every pixel has so many samples, a power of 2 and not all; `picture` makes one of these.
using OnSamples = std::function<void(uint32_t samples, const std::function<FrameResult()>& picture)>;

// Sees every pass as it runs; parity/ and tests hook in here.
class Renderer {
 public:
  // Uploads everything static and runs `links`. The scene, assembly and atlas must outlive the renderer.
  // Throws Error(usage) where sweeps are wanted of mapped charts whose maps the atlas does not have, and
  // where something is to move, or get coarser, of which the assembly has instances; and where
  // Settings::device_memory is too little.
  Renderer(Backend& backend, const scene::Scene& scene, const scene::Assembly& assembly,
           const geometry_image::Atlas& atlas, const Settings& settings);
  ~Renderer();

  // One frame. `interrupted` is asked between dispatches; where it says yes, nothing is returned, or with
  // Settings::progressive what there is, once every pixel has a sample. `shutter`:
  // with motion blur, the moments at the ends of its segments, from the opening to the closing; lights and
  // tangents are those of `pose`, in between. Throws Error(usage) where there is another number of them.
  std::optional<FrameResult> render(const scene::Pose& pose, const View& view,
                                    const std::function<bool()>& interrupted = {},
                                    const std::vector<Moment>& shutter = {},
                                    const OnSamples& on_samples = {});

  std::vector<PassRecord> setup_passes() const;  // the records of `links`
  Traversal traversal() const;                   // what `automatic` became
  std::optional<Streaming> streaming() const;    // so far; none: all of the scene is on the device

  // The pieces of a frame, for benchmarks: blend, relax, rasterise and bounds, and the texel map that they
  // were for; then given rays (two vec4 each: origin and tmin, direction and tmax) against the hierarchy,
  // closest hit, results t u v primitive. Without motion blur. `view`: what levels of detail are for; null:
  // rays tolerate no error.
  void update(const scene::Pose& pose, const View* view = nullptr);
  std::vector<glm::uvec4> texel_map();
  void load_rays(const std::vector<glm::vec4>& rays);
  void trace_loaded();
  std::vector<glm::uvec4> hits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

const char* to_string(Traversal traversal);
const char* to_string(Integrator integrator);

// A back end that runs every pass on `device` and, on the very inputs the device had, on `reference`, and
// compares what they wrote, word by word.
struct PassDifference {
  std::string pass, buffer;
  uint64_t words = 0, different = 0;  // words compared, words that differ
  uint64_t first = 0;                 // word index of the first one
  uint32_t device_value = 0, reference_value = 0;
  uint64_t dispatches = 0;
};

// A bit flipped on purpose in what `pass` wrote on the device.
struct Fault {
  std::string pass;
  uint32_t bit = 0;
};

class ParityBackend : public Backend {
 public:
  // Both must outlive it.
  ParityBackend(Backend& device, Backend& reference, std::optional<Fault> fault = {});
  ~ParityBackend() override;
  const DeviceInfo& info() const override;
  BufferId create(const BufferDesc& desc) override;
  void destroy(BufferId buffer) override;
  void upload(BufferId buffer, std::span<const std::byte> bytes, uint64_t offset_bytes) override;
  void download(BufferId buffer, std::span<std::byte> bytes, uint64_t offset_bytes) override;
  const BufferDesc& desc(BufferId buffer) const override;
  void run(const Dispatch& dispatch) override;
  std::vector<PassRecord> finish() override;
  uint64_t allocated_bytes() const override;

  // One row a pass and written buffer, in order of first use.
  const std::vector<PassDifference>& differences() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodestone::render
