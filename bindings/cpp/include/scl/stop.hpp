/// Stop requests: SIGTERM and SIGINT.
#pragma once

#include <scl.h>

namespace scl {

/// Returns true once the program was asked to stop, by SIGTERM or Ctrl-C.
///
/// Calls to gates then throw `scl::Stopped`, including waiting ones, and ranges of received messages end. A program
/// that is still running after `SCL_STOP_WITHIN` (default 3 s) is ended, as is one that receives a second signal half
/// a second or more after the first.
inline bool stop_requested() noexcept { return scl_stop_requested(); }

/// From now on the program handles stop requests itself: its gates keep working after the request, so it must check
/// `stop_requested()`. For programs that have something to send before they end.
inline void handle_stop() noexcept { scl_handle_stop(); }

} // namespace scl
