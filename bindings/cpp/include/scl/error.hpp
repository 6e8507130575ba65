/// Errors: exceptions, one class for each kind that programs handle differently, and the same kinds as
/// `std::error_code`.
#pragma once

#include <scl.h>

#include <stdexcept>
#include <string>
#include <system_error>

namespace scl {

/// The kinds of errors. `std::error_code` values of SCL compare equal to them: `if (error == scl::Errc::stopped)`.
enum class Errc : int {
    /// The queue of a peer with `when_full: wait` is full; nothing was sent.
    full = SCL_FULL,
    /// The time limit is over.
    timeout = SCL_TIMEOUT,
    /// The program was asked to stop by SIGTERM or SIGINT.
    stopped = SCL_STOPPED,
    /// The peer disconnected after the request was sent; whether it acted on the request is unknown.
    peer_lost = SCL_PEER_LOST,
    /// The peer that made a request no longer waits for the reply.
    requester_gone = SCL_REQUESTER_GONE,
    /// Another thread is using this gate.
    busy = SCL_BUSY,
    /// The message is longer than the peer accepts; nothing was sent.
    too_long = SCL_TOO_LONG,
    /// The bytes received are not a message of the expected type. The next call returns the next message.
    decode = SCL_DECODE,
    /// Not all peers have taken all messages. The component was closed nevertheless.
    not_flushed = SCL_NOT_FLUSHED,
    /// A wrong argument, for example a gate that was moved to another object.
    argument = SCL_ARGUMENT,
    /// The component or the request is closed.
    handle = SCL_HANDLE,
    /// The system has no component, or the component no gate, with this name.
    name = SCL_NAME,
    /// The gate is of another kind.
    kind = SCL_KIND,
    /// The plan is not valid, or was written for another version of SCL.
    plan = SCL_PLAN,
    /// The component is already running.
    taken = SCL_TAKEN,
    /// The runtime folder cannot be used.
    folder = SCL_FOLDER,
    /// An environment variable has a value that is not understood.
    environment = SCL_ENVIRONMENT,
    /// The component was closed by another thread during the call.
    closed = SCL_CLOSED,
    /// The component was opened before a `fork` and belongs to the parent process.
    forked = SCL_FORKED,
    /// The operating system refused something.
    system = SCL_SYSTEM,
    /// A bug in SCL.
    panic = SCL_PANIC,
    /// Any other failure.
    failed = SCL_FAILED,
    /// The codec cannot express the message. (Codecs are part of this library alone, so the C library has no such
    /// status.)
    encode = -1000,
};

/// The category of SCL's error codes.
const std::error_category& error_category() noexcept;

inline std::error_code make_error_code(Errc error) noexcept { return {static_cast<int>(error), error_category()}; }

} // namespace scl

template <> struct std::is_error_code_enum<scl::Errc> : std::true_type {};

namespace scl {

/// The base of all exceptions of SCL. `what()` names component, gate and peer, and says what to do.
class Error : public std::runtime_error {
  public:
    Error(Errc code, const std::string& text) : std::runtime_error(text), code_(code) {}

    /// The kind of error.
    std::error_code code() const noexcept { return code_; }

  private:
    Errc code_;
};

namespace detail {

/// An exception class of its own for one kind of error.
template <Errc kind> class ErrorOf : public Error {
  public:
    explicit ErrorOf(const std::string& text) : Error(kind, text) {}
};

} // namespace detail

/// The program was asked to stop by SIGTERM or Ctrl-C. This is not a failure: if no `catch` handles it, the program
/// ends with exit code 0.
class Stopped : public detail::ErrorOf<Errc::stopped> {
    using ErrorOf::ErrorOf;
};

/// Peers are not ready, or have not replied, in time.
class Timeout : public detail::ErrorOf<Errc::timeout> {
    using ErrorOf::ErrorOf;
};

/// The queue of a peer with `when_full: wait` stayed full; nothing was sent.
class Full : public detail::ErrorOf<Errc::full> {
    using ErrorOf::ErrorOf;
};

/// The replier disconnected after the request was sent; whether it acted on the request is unknown.
class PeerLost : public detail::ErrorOf<Errc::peer_lost> {
    using ErrorOf::ErrorOf;
};

/// The requester no longer waits for the reply. A replier may well ignore it.
class RequesterGone : public detail::ErrorOf<Errc::requester_gone> {
    using ErrorOf::ErrorOf;
};

/// The component is already running, in this process or another one, which the text names.
class Taken : public detail::ErrorOf<Errc::taken> {
    using ErrorOf::ErrorOf;
};

/// The message is longer than the peer accepts (`max_size` in the topology file); nothing was sent.
class TooLong : public detail::ErrorOf<Errc::too_long> {
    using ErrorOf::ErrorOf;
};

/// The bytes received are not a message of the expected type. The next call returns the next message.
class DecodeError : public detail::ErrorOf<Errc::decode> {
    using ErrorOf::ErrorOf;
};

/// The codec cannot express the message; nothing was sent.
class EncodeError : public detail::ErrorOf<Errc::encode> {
    using ErrorOf::ErrorOf;
};

/// Not all peers have taken all messages. The component was closed nevertheless.
class NotFlushed : public detail::ErrorOf<Errc::not_flushed> {
    using ErrorOf::ErrorOf;
};

namespace detail {

/// The text of this thread's last error if it came from a codec, else empty.
inline std::string& own_error() noexcept {
    thread_local std::string text;
    return text;
}

} // namespace detail

/// The text of this thread's last failed call, for calls that report errors as `std::error_code`, whose `message()`
/// knows neither gate nor peer. Valid until the thread's next failure.
inline const char* last_error() noexcept {
    const std::string& own = detail::own_error();
    return own.empty() ? scl_error() : own.c_str();
}

namespace detail {

class Category final : public std::error_category {
  public:
    const char* name() const noexcept override { return "scl"; }

    std::string message(int code) const override {
        switch (static_cast<Errc>(code)) {
        case Errc::full:
            return "the queue of a peer is full";
        case Errc::timeout:
            return "not done in time";
        case Errc::stopped:
            return "stop requested";
        case Errc::peer_lost:
            return "the peer disconnected after the request was sent";
        case Errc::requester_gone:
            return "the requester no longer waits for the reply";
        case Errc::busy:
            return "another thread is using this gate";
        case Errc::too_long:
            return "the message is longer than the peer accepts";
        case Errc::decode:
            return "the bytes received are not a message of the expected type";
        case Errc::not_flushed:
            return "not all peers have taken all messages";
        case Errc::taken:
            return "the component is already running";
        case Errc::handle:
        case Errc::closed:
            return "the component is closed";
        case Errc::forked:
            return "the component belongs to the parent process";
        case Errc::encode:
            return "the codec cannot express the message";
        default:
            return scl_status_name(code);
        }
    }
};

/// Throws the exception class of a kind.
[[noreturn]] inline void raise(Errc kind, const std::string& text) {
    switch (kind) {
    case Errc::stopped:
        throw Stopped(text);
    case Errc::timeout:
        throw Timeout(text);
    case Errc::full:
        throw Full(text);
    case Errc::peer_lost:
        throw PeerLost(text);
    case Errc::requester_gone:
        throw RequesterGone(text);
    case Errc::taken:
        throw Taken(text);
    case Errc::too_long:
        throw TooLong(text);
    case Errc::decode:
        throw DecodeError(text);
    case Errc::encode:
        throw EncodeError(text);
    case Errc::not_flushed:
        throw NotFlushed(text);
    default:
        throw Error(kind, text);
    }
}

/// Throws the exception of a status unless it is `SCL_OK`.
inline void check(scl_status status) {
    if (status != SCL_OK) {
        raise(static_cast<Errc>(status), scl_error());
    }
}

/// Throws if the library is of another version than the headers.
inline void check_library() {
    if (scl_abi() != SCL_ABI) {
        raise(Errc::failed, "this program was compiled with version " + std::to_string(SCL_ABI) +
                                " of the interface of SCL and loaded a library of version " +
                                std::to_string(scl_abi()) + "; compile it again, or install the other library");
    }
}

} // namespace detail

inline const std::error_category& error_category() noexcept {
    static const detail::Category category;
    return category;
}

} // namespace scl
