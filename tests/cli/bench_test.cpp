// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "process.h"

namespace lodestone::cli {
namespace {

using Json = nlohmann::json;

const std::vector<std::string> tiny_bench = {
    "bench", "builtin:tiny", "--device", "cpu",         "--size",
    "32x32", "--repeats",    "3",        "--traversal", "threaded,octant,wide"};

void expect_spread(const Json& spread) {
  EXPECT_GT(spread["min"].get<double>(), 0);
  EXPECT_LE(spread["min"].get<double>(), spread["median"].get<double>());
  EXPECT_LE(spread["median"].get<double>(), spread["max"].get<double>());
}

TEST(Bench, MeasuresRaysAndPassesOfEveryTraversalWithTheirSpread) {
  std::vector<std::string> arguments = tiny_bench;
  arguments.push_back("--json");
  const Result result = run(arguments);
  ASSERT_EQ(result.code, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["repeats"], 3);
  ASSERT_EQ(json["results"].size(), 3u);
  EXPECT_EQ(json["results"][2]["traversal"], "wide");
  for (const Json& one : json["results"]) {
    expect_spread(one["update_ms"]);
    EXPECT_EQ(one["update"][0]["name"], "blend");
    ASSERT_EQ(one["rays"].size(), 2u);
    for (const Json& kind : one["rays"]) {
      EXPECT_EQ(kind["rays"], 32 * 32);
      expect_spread(kind["mrays_per_s"]);
    }
  }
}

TEST(Bench, EveryTraversalHitsTheSame) {
  std::vector<std::string> arguments = tiny_bench;
  arguments.push_back("--json");
  const Json results = Json::parse(run(arguments).out)["results"];
  for (const size_t kind : {size_t(0), size_t(1)}) {
    const Json& hits = results[0]["rays"][kind]["hits"];
    EXPECT_GT(hits.get<int>(), 20);
    EXPECT_LT(hits.get<int>(), 32 * 32);
    EXPECT_EQ(results[1]["rays"][kind]["hits"], hits);
    EXPECT_EQ(results[2]["rays"][kind]["hits"], hits);
  }
}

TEST(Bench, PrintsATable) {
  const Result result = run(tiny_bench);
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* part : {"median", "octant", "primary", "incoherent", "update", "Mrays/s"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace lodestone::cli
