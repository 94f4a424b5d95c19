// SPDX-License-Identifier: MIT
// Animations (3.11).
#include <optional>

#include "lodestone/base/error.h"
#include "lodestone/base/log.h"
#include "lodestone/scene/gltf_convert.h"
#include "lodestone/scene/text_reader.h"

namespace lodestone::scene {
namespace {

class AnimationConverter {
 public:
  AnimationConverter(const AccessorReader& reader, const std::vector<uint32_t>& node_of, const Scene& scene,
                     size_t index)
      : reader_(reader),
        node_of_(node_of),
        scene_(scene),
        source_(reader.model().animations[index]),
        label_(gltf_label("animation", index, source_.name)) {
    animation_.name = source_.name.empty() ? fmt::format("animation{}", index) : source_.name;
  }

  Animation convert() {
    for (size_t i = 0; i < source_.channels.size(); ++i) {
      std::optional<Channel> channel = convert_channel(i);
      if (channel) animation_.channels.push_back(std::move(*channel));
    }
    return std::move(animation_);
  }

 private:
  // Nothing where the channel moves what is not drawn.
  std::optional<Channel> convert_channel(size_t i) const {
    const tinygltf::AnimationChannel& from = source_.channels[i];
    const std::string use = fmt::format("{}, channel {}", label_, i);
    const uint32_t sampler = gltf_index(reader_, from.sampler, source_.samplers.size(), use + ", sampler");
    const uint32_t node = gltf_index(reader_, from.target_node, node_of_.size(), use + ", node");
    if (sampler == none || node == none)
      fail_input(reader_.file(), "{}: has no target; export it again", use);
    Channel to;
    to.node = node_of_[node];
    const Node& moved = scene_.nodes[to.node];
    const std::optional<Channel::Path> path = find_path(from.target_path, use);
    if (!path) return {};
    to.path = *path;
    if (to.path == Channel::Path::weights && moved.mesh == none) return {};
    if (to.path != Channel::Path::weights && moved.matrix) {
      fail_input(reader_.file(),
                 "{}: moves a node that has a matrix; export it with translation, rotation, scale", use);
    }
    read_keys(source_.samplers[sampler], use, to);
    return to;
  }

  std::optional<Channel::Path> find_path(const std::string& path, const std::string& use) const {
    if (path == "translation") return Channel::Path::translation;
    if (path == "rotation") return Channel::Path::rotation;
    if (path == "scale") return Channel::Path::scale;
    if (path == "weights") return Channel::Path::weights;
    log::warn_once(reader_.file() + " animation path " + path,
                   fmt::format("{}: {}: what it moves ('{}') is not known; the channel is ignored",
                               reader_.file(), use, printable(path)));
    return {};
  }

  Channel::Interpolation interpolation(const std::string& name, const std::string& use) const {
    if (name == "LINEAR") return Channel::Interpolation::linear;
    if (name == "STEP") return Channel::Interpolation::step;
    if (name == "CUBICSPLINE") return Channel::Interpolation::cubic_spline;
    fail_input(reader_.file(), "{}: interpolation '{}' does not exist; export it again", use,
               printable(name));
  }

  void read_keys(const tinygltf::AnimationSampler& sampler, const std::string& use, Channel& to) const {
    to.interpolation = interpolation(sampler.interpolation, use);
    to.times = reader_.scalars(sampler.input, use + ", input");
    for (size_t k = 0; k < to.times.size(); ++k) {
      if (k > 0 && to.times[k] <= to.times[k - 1]) {
        fail_input(reader_.file(), "{}: the times of keys {} and {} do not ascend; export it again", use,
                   k - 1, k);
      }
    }
    to.values = read_values(sampler.output, use + ", output", to);
    size_t width = to.path == Channel::Path::rotation ? 4 : 3;
    if (to.path == Channel::Path::weights) width = scene_.meshes[scene_.nodes[to.node].mesh].targets.size();
    if (to.interpolation == Channel::Interpolation::cubic_spline) width *= 3;
    if (width == 0)
      fail_input(reader_.file(), "{}: moves morph weights of a mesh without targets; export it again", use);
    if (to.values.size() != to.times.size() * width) {
      fail_input(reader_.file(), "{}: {} values for {} keys of {}; export it again", use, to.values.size(),
                 to.times.size(), width);
    }
  }

  std::vector<float> read_values(int output, const std::string& use, const Channel& channel) const {
    std::vector<float> values;
    if (channel.path == Channel::Path::weights) return reader_.scalars(output, use);
    if (channel.path == Channel::Path::rotation) {
      for (const glm::vec4& q : reader_.vec4s(output, use)) values.insert(values.end(), {q.x, q.y, q.z, q.w});
    } else {
      for (const glm::vec3& v : reader_.vec3s(output, use)) values.insert(values.end(), {v.x, v.y, v.z});
    }
    return values;
  }

  const AccessorReader& reader_;
  const std::vector<uint32_t>& node_of_;
  const Scene& scene_;
  const tinygltf::Animation& source_;
  std::string label_;
  Animation animation_;
};

}  // namespace

void convert_animations(const AccessorReader& reader, const std::vector<uint32_t>& node_of, Scene& scene) {
  for (size_t i = 0; i < reader.model().animations.size(); ++i) {
    scene.animations.push_back(AnimationConverter(reader, node_of, scene, i).convert());
  }
}

}  // namespace lodestone::scene
