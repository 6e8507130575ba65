/// Stop requests: SIGTERM and SIGINT.
#pragma once

#include <scl.h>

namespace scl {

/// Returns true once the program has been asked to stop, by SIGTERM or Ctrl-C. The first call tells SCL that the program
/// handles stop requests itself: see docs/cpp.md, "Stopping".
inline bool stop_requested() noexcept { return scl_stop_requested(); }

} // namespace scl
