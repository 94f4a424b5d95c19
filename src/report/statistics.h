// SPDX-License-Identifier: MIT
// The file that `--stats` writes. Its form is a contract: scripts outside the project read it.
#pragma once

#include <string>

#include "lodestone/report/measurements.h"

namespace lodestone::report {

// One JSON object. What the device cannot give, or nobody counted, is null. A pass of a CPU run has, beside
// its null `device_ms`, a `wall_ms` in its place. `image` says how pictures were denoised, where they were. A
// megabyte is a million bytes; `peak_rss_mb` is of the moment of the call.
std::string statistics_json(const RunRecord& run);

// The most memory that this process has had resident, in megabytes of a million bytes.
double peak_rss_mb();

}  // namespace lodestone::report
