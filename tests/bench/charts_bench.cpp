// SPDX-License-Identifier: MIT
// Resampled charts beside the atlas `exact`, on the same device and the same rays: against the exact atlas of
// the input, at several budgets, with the error that is paid; and against the exact atlas of the charts' own
// triangles, which have the same error because they are the same surface. Turns are taken round by round;
// medians of ratios count. charts_bench [--scenes armadillo.obj,...] [--budgets 0.25,...] [--devices
// cpu,llvmpipe] [--rounds N] [--time S]
#include <fmt/format.h>

#include "lodestone/base/error.h"
#include "lodestone/geometry_image/fidelity.h"
#include "lodestone/layout/atlas.h"
#include "lodestone/scene/load.h"
#include "lodestone/test_support/bench_main.h"
#include "lodestone/test_support/charts_choice.h"
#include "lodestone/test_support/contender.h"
#include "lodestone/test_support/image_scene.h"
#include "lodestone/test_support/median.h"
#include "lodestone/test_support/rays.h"
#include "lodestone/test_support/rounds.h"

namespace lodestone::test {
namespace {

using geometry_image::AtlasKind;

struct Choice : ChartsChoice {
  Choice() {
    scenes = {"armadillo.obj", "stanford_bunny.obj", "scallop.glb", "ict_face_sparse.glb"};
    budgets = {0.25, 0.5, 1, 2};
  }
  uint32_t incoherent = 262144;
  float time = 0.4f;
  bool counters = false;
};

// The charts of one budget, and the same triangles as an exact atlas.
struct Pair {
  double budget;
  ReadyScene charts, same;
  geometry_image::Fidelity fidelity;  // of both
};

struct Subject {
  std::string name;
  ReadyScene exact;
  scene::Pose pose;
  std::vector<Pair> pairs;
  Rays primary, incoherent;
};

Pair make_pair(const Subject& subject, double budget) {
  ReadyScene charts = with_charts(subject.exact, budget);
  const auto fidelity =
      geometry_image::measure_fidelity(charts.scene, charts.assembly, charts.atlas, subject.pose);
  if (!fidelity) fail_input(subject.name, "nothing of it can be resampled: take another scene");
  ReadyScene same(image_scene(charts, subject.pose), AtlasKind::exact);
  return {budget, std::move(charts), std::move(same), *fidelity};
}

Subject make_subject(const std::string& name, const Choice& choice) {
  ReadyScene exact(data_file(name).value_or(name), AtlasKind::exact);
  const scene::Pose pose = exact.pose(choice.time);
  Subject subject{name, std::move(exact), pose, {}, {}, {}};
  for (const double budget : choice.budgets) subject.pairs.push_back(make_pair(subject, budget));
  const auto bounds = scene::pose_bounds(subject.exact.scene, pose);
  subject.primary = primary_rays(
      render::find_view(subject.exact.scene, pose, "", bounds, choice.size, choice.size), choice.size);
  // Rays start clear of both surfaces, for what lies between them would be hit at once by one and not by the
  // other.
  constexpr float clearance = 0.01f;
  subject.incoherent = surface_rays(subject.exact.texels(pose), quad_triangles(subject.exact.atlas).texels,
                                    choice.incoherent, 5, clearance * glm::length(bounds.hi - bounds.lo));
  return subject;
}

double atlas_megabytes(const geometry_image::Atlas& atlas) {
  return double(atlas.texel_map.size() * sizeof(glm::uvec4) + atlas.leaf_map.size() * sizeof(glm::uvec2) +
                atlas.charts.size() * sizeof(layout::ChartRecord)) /
         1e6;
}

void print_sizes(const Subject& subject, const std::string& device) {
  fmt::print("\n{} on {}: {} triangles\n{:<12} {:>9} {:>9} {:>9} {:>10} {:>10} {:>9} {:>11}\n", subject.name,
             device, subject.exact.assembly.triangles.size(), "atlas", "texels", "charts", "slots",
             "atlas MB", "device MB", "RMS", "Hausdorff");
  const auto row = [&](const std::string& name, const ReadyScene& ready, double rms, double hausdorff) {
    const Contender contender(ready, device);
    fmt::print("{:<12} {:>9} {:>9} {:>9} {:>10.2f} {:>10.2f} {:>8.4f}% {:>10.4f}%\n", name,
               ready.atlas.texel_map.size(), ready.atlas.charts.size(), ready.atlas.leaf_map.size(),
               atlas_megabytes(ready.atlas), double(contender.allocated_bytes()) / 1e6, 100 * rms,
               100 * hausdorff);
  };
  row("exact", subject.exact, 0, 0);
  for (const Pair& pair : subject.pairs) {
    const double rms = pair.fidelity.root_mean_square, hausdorff = pair.fidelity.hausdorff();
    row(fmt::format("charts {:g}", pair.budget), pair.charts, rms, hausdorff);
    row("  as exact", pair.same, rms, hausdorff);
  }
}

// What a ray costs in steps, which no other program on the machine can change.
void print_counters(const Subject& subject, const std::string& device) {
  fmt::print("{:<12} {:<11} {:>9} {:>9} {:>13}   a ray\n", "atlas", "rays", "nodes", "boxes", "triangles");
  const auto row = [&](const std::string& name, const ReadyScene& ready, const scene::Pose& pose) {
    render::BackendOptions options;
    options.counters = true;
    Contender contender(ready, device, options);
    contender.renderer().update(pose);
    for (const auto& [kind, rays] :
         {std::pair{"primary", &subject.primary}, std::pair{"incoherent", &subject.incoherent}}) {
      contender.renderer().load_rays(*rays);
      contender.renderer().trace_loaded();
      const render::Counters counted = contender.take_counters("trace");
      const double count = double(rays->size() / 2);
      fmt::print("{:<12} {:<11} {:>9.2f} {:>9.2f} {:>13.2f}\n", name, kind,
                 double(counted.node_visits) / count, double(counted.box_tests) / count,
                 double(counted.triangle_tests) / count);
    }
  };
  row("exact", subject.exact, subject.pose);
  for (const Pair& pair : subject.pairs) {
    row(fmt::format("charts {:g}", pair.budget), pair.charts, subject.pose);
    row("  as exact", pair.same, scene::evaluate(pair.same.scene, scene::none, 0));
  }
}

// Seconds, one a round.
struct Times {
  std::vector<double> exact;
  std::vector<std::vector<double>> charts, same;  // by pair
};

class Arena {
 public:
  Arena(const Subject& subject, const std::string& device)
      : subject_(subject), exact_(subject.exact, device) {
    for (const Pair& pair : subject.pairs) {
      charts_.emplace_back(pair.charts, device);
      same_.emplace_back(pair.same, device);
    }
  }

  // `run` takes a contender and the pose it is in, and returns seconds.
  template <class Run>
  Times take_turns(int rounds, Run run) {
    const scene::Pose still = scene::evaluate(subject_.pairs[0].same.scene, scene::none, 0);
    Times times{{},
                std::vector<std::vector<double>>(charts_.size()),
                std::vector<std::vector<double>>(charts_.size())};
    for (int round = 0; round < rounds; ++round) {
      times.exact.push_back(run(exact_, subject_.pose));
      for (size_t i = 0; i < charts_.size(); ++i) {
        times.charts[i].push_back(run(charts_[i], subject_.pose));
        times.same[i].push_back(run(same_[i], still));
      }
    }
    return times;
  }

  // The exact atlas of the same triangles must say what the charts say, but for rays that graze an edge.
  void check_hits() {
    constexpr double allowed = 1e-3;
    for (size_t i = 0; i < charts_.size(); ++i) {
      const auto a = charts_[i].renderer().hits(), b = same_[i].renderer().hits();
      uint64_t different = 0;
      for (size_t ray = 0; ray < a.size(); ++ray)
        different += (a[ray].w == layout::no_index) != (b[ray].w == layout::no_index);
      if (double(different) > allowed * double(a.size()))
        fail(ExitCode::different, subject_.name,
             "{} of {} rays hit the charts or their triangles, but not both", different, a.size());
    }
  }

 private:
  const Subject& subject_;
  Contender exact_;
  std::vector<Contender> charts_, same_;
};

std::vector<double> ratios(const std::vector<double>& theirs, const std::vector<double>& ours) {
  std::vector<double> each;
  for (size_t i = 0; i < ours.size(); ++i) each.push_back(theirs[i] / ours[i]);
  return each;
}

void print_times(const Subject& subject, const char* what, const char* unit, double work,
                 const Times& times) {
  const auto value = [&](const std::vector<double>& seconds) {
    return work > 0 ? work / median(seconds) / 1e6 : median(seconds) * 1e3;
  };
  for (size_t i = 0; i < subject.pairs.size(); ++i) {
    fmt::print("{:<11} {:>6g} {:>9.2f} {:>9.2f} {:>9.2f} {:<8} {:>22} {:>22}\n", what,
               subject.pairs[i].budget, value(times.exact), value(times.same[i]), value(times.charts[i]),
               unit, spread(ratios(times.exact, times.charts[i])),
               spread(ratios(times.same[i], times.charts[i])));
  }
  std::fflush(stdout);
}

void bench(const Subject& subject, const std::string& device, const Choice& choice) {
  const int rounds = choice.rounds;
  print_sizes(subject, device);
  if (choice.counters) print_counters(subject, device);
  fmt::print("{:<11} {:>6} {:>9} {:>9} {:>9} {:<8} {:>22} {:>22}\n", "what", "charts", "exact", "as exact",
             "charts", "unit", "times as fast as exact", "as exact of the same");
  Arena arena(subject, device);
  const auto update = [](Contender& contender, const scene::Pose& pose) {
    contender.take_passes();
    contender.renderer().update(pose);
    double sum = 0;
    for (const auto& [pass, time] : contender.take_passes()) sum += time;
    return sum;
  };
  arena.take_turns(1, update);
  print_times(subject, "update", "ms", 0, arena.take_turns(rounds, update));
  for (const auto& [what, rays] :
       {std::pair{"primary", &subject.primary}, std::pair{"incoherent", &subject.incoherent}}) {
    const auto trace = [](Contender& contender, const scene::Pose&) {
      return seconds([&] { contender.renderer().trace_loaded(); });
    };
    arena.take_turns(1, [&, list = rays](Contender& contender, const scene::Pose& pose) {
      contender.renderer().load_rays(*list);
      return trace(contender, pose);
    });
    arena.check_hits();
    print_times(subject, what, "Mrays/s", double(rays->size() / 2), arena.take_turns(rounds, trace));
  }
}

}  // namespace
}  // namespace lodestone::test

int main(int argc, char** argv) {
  using namespace lodestone::test;
  Choice choice;
  CLI::App app("Resampled charts beside the exact atlas", "charts_bench");
  choice.add_options(app);
  app.add_option("--incoherent", choice.incoherent, "Incoherent rays")->check(CLI::Range(1, 1 << 24));
  app.add_option("--time", choice.time, "Seconds of the first clip");
  app.add_flag("--counters", choice.counters, "Count the steps of rays, too");
  return bench_main(app, argc, argv, [&] {
    for (const std::string& name : choice.scenes) {
      const Subject subject = make_subject(name, choice);
      for (const std::string& device : choice.devices) bench(subject, device, choice);
    }
  });
}
