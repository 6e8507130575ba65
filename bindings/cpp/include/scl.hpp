/// SCL for C++: typed components and gates over ZeroMQ, wired by one checked topology file. See docs/cpp.md.
///
/// The codecs of protobuf messages are in `scl/protobuf.hpp` and `scl/json.hpp`, because they need libprotobuf. Headers
/// that `scl generate --for cpp` writes include the ones that they need.
#pragma once

#include <scl/bytes.hpp>
#include <scl/codec.hpp>
#include <scl/component.hpp>
#include <scl/error.hpp>
#include <scl/options.hpp>
#include <scl/parameter.hpp>
#include <scl/receiving.hpp>
#include <scl/rep.hpp>
#include <scl/req.hpp>
#include <scl/sending.hpp>
#include <scl/stop.hpp>
#include <scl/time.hpp>
#include <scl/wait.hpp>
