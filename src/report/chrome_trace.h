// SPDX-License-Identifier: MIT
// The file that `--profile` writes: the Trace Event Format that Perfetto and chrome://tracing open.
#pragma once

#include <string>

#include "lodestone/report/measurements.h"

namespace lodestone::report {

// Complete events (`ph` X, microseconds since the program started) on two tracks: the host's stages and
// frames, and the device's dispatches, one event each. A dispatch is as long as the device's timestamps say,
// or the host's clock where there are none; no two overlap on the track, so one that was enqueued while
// another ran starts at its end.
std::string chrome_trace(const RunRecord& run);

}  // namespace lodestone::report
