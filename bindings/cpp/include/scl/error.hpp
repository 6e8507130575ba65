/// Errors: exceptions, one class for each kind that programs handle differently, and the same kinds as
/// `std::error_code`.
#pragma once

#include <scl.h>

#include <stdexcept>
#include <string>
#include <system_error>

namespace scl {

/// The kinds of errors. `std::error_code` values of SCL compare equal to them: `if (error == scl::Errc::stopped)`.
/// Kinds that the operating system also has compare equal to `std::errc`, too: `if (error == std::errc::timed_out)`.
enum class Errc : int {
    /// The queue of a peer with `when_full: wait` is full; nothing was sent.
    full = SCL_FULL,
    /// The time limit has expired.
    timeout = SCL_TIMEOUT,
    /// The program was asked to stop by SIGTERM or SIGINT.
    stopped = SCL_STOPPED,
    /// The peer disconnected after the request was sent; whether it acted on the request is unknown.
    peer_lost = SCL_PEER_LOST,
    /// The replier could not decode the request, so it did not act on it.
    refused = SCL_REFUSED,
    /// The peer that made a request no longer waits for the reply.
    requester_gone = SCL_REQUESTER_GONE,
    /// Another thread is using this gate.
    busy = SCL_BUSY,
    /// The message is longer than the peer accepts; nothing was sent.
    too_long = SCL_TOO_LONG,
    /// The bytes received are not a message of the expected type. The next call returns the next message.
    decode = SCL_DECODE,
    /// The codec cannot express the message, or a text in it is not UTF-8; nothing was sent.
    encode = SCL_ENCODE,
    /// Not all peers have taken all messages. The component was closed nevertheless.
    not_flushed = SCL_NOT_FLUSHED,
    /// A wrong argument, for example a gate that was moved to another object.
    argument = SCL_ARGUMENT,
    /// The component or the request is closed.
    handle = SCL_HANDLE,
    /// The system has no component, or the component no gate or parameter, with this name.
    name = SCL_NAME,
    /// The gate is of another kind, or the parameter of another type.
    kind = SCL_KIND,
    /// The plan is not valid, or was written for another version of SCL.
    plan = SCL_PLAN,
    /// The component is already running.
    taken = SCL_TAKEN,
    /// The runtime folder cannot be used.
    folder = SCL_FOLDER,
    /// An environment variable has a value that is not understood, or a parameter has no value or a wrong one.
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
};

/// The category of SCL's error codes.
const std::error_category& error_category() noexcept;

inline std::error_code make_error_code(Errc error) noexcept { return {static_cast<int>(error), error_category()}; }

} // namespace scl

template <> struct std::is_error_code_enum<scl::Errc> : std::true_type {};

namespace scl {

/// Returns the corresponding error of the operating system, to which `std::errc` belongs.
inline std::error_condition make_error_condition(Errc error) noexcept {
    return make_error_code(error).default_error_condition();
}

inline bool operator==(Errc own, std::errc system) noexcept { return make_error_code(own) == system; }
inline bool operator==(std::errc system, Errc own) noexcept { return own == system; }
inline bool operator!=(Errc own, std::errc system) noexcept { return !(own == system); }
inline bool operator!=(std::errc system, Errc own) noexcept { return !(own == system); }

/// The base of all exceptions of SCL except `Stopped`. `what()` names component, gate and peer, and says what to do.
class Error : public std::runtime_error {
  public:
    Error(Errc code, const std::string& text) : std::runtime_error(text), code_(code) {}

    /// The kind of error.
    std::error_code code() const noexcept { return code_; }

  private:
    Errc code_;
};

namespace detail {

/// The exception class for one kind of error.
template <Errc own> class ErrorOf : public Error {
  public:
    static constexpr Errc kind = own;

    explicit ErrorOf(const std::string& text) : Error(kind, text) {}
};

} // namespace detail

/// The program was asked to stop by SIGTERM or Ctrl-C. This is not a failure: if no `catch` handles it, the program
/// ends with exit code 0.
///
/// It is neither an `Error` nor a `std::exception`, so that a loop that logs errors and continues does not swallow it.
class Stopped {
  public:
    explicit Stopped(const std::string& text) : text_(text) {}

    const char* what() const noexcept { return text_.what(); }

    /// `Errc::stopped`.
    std::error_code code() const noexcept { return Errc::stopped; }

  private:
    /// Copying a `std::string` may throw, which an exception must not.
    std::runtime_error text_;
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

/// The replier could not decode the request, so it did not act on it.
class Refused : public detail::ErrorOf<Errc::refused> {
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

/// The codec cannot express the message, or a text in it is not UTF-8; nothing was sent.
class EncodeError : public detail::ErrorOf<Errc::encode> {
    using ErrorOf::ErrorOf;
};

/// Not all peers have taken all messages. The component was closed nevertheless.
class NotFlushed : public detail::ErrorOf<Errc::not_flushed> {
    using ErrorOf::ErrorOf;
};

/// The text of this thread's last failed call, for calls that report errors as `std::error_code`, whose `message()`
/// knows neither gate nor peer. It stays as it is until 16 more calls of the thread have failed or the thread ends.
inline const char* last_error() noexcept { return scl_error(); }

namespace detail {

/// What error codes say about a kind of error.
struct Meaning {
    Errc kind;
    /// If nullptr, the name of the status is used.
    const char* text;
    /// The corresponding error of the operating system, or none.
    std::errc system;
};

inline constexpr Meaning meanings[] = {
    {Errc::full, "the queue of a peer is full", std::errc::resource_unavailable_try_again},
    {Errc::timeout, "not done in time", std::errc::timed_out},
    {Errc::stopped, "stop requested", std::errc::interrupted},
    {Errc::peer_lost, "the peer disconnected after the request was sent", std::errc::connection_reset},
    {Errc::requester_gone, "the requester no longer waits for the reply", std::errc::broken_pipe},
    {Errc::busy, "another thread is using this gate", std::errc::device_or_resource_busy},
    {Errc::too_long, "the message is longer than the peer accepts", std::errc::message_size},
    {Errc::decode, "the bytes received are not a message of the expected type", std::errc::bad_message},
    {Errc::encode, "the codec cannot express the message", std::errc::invalid_argument},
    {Errc::argument, nullptr, std::errc::invalid_argument},
    {Errc::not_flushed, "not all peers have taken all messages", std::errc{}},
    {Errc::kind, nullptr, std::errc::operation_not_supported},
    {Errc::taken, "the component is already running", std::errc::address_in_use},
    {Errc::handle, "the component is closed", std::errc::bad_file_descriptor},
    {Errc::closed, "the component is closed", std::errc::operation_canceled},
    {Errc::forked, "the component belongs to the parent process", std::errc::operation_not_permitted},
};

class Category final : public std::error_category {
  public:
    const char* name() const noexcept override { return "scl"; }

    std::string message(int code) const override {
        const char* text = meaning(code).text;
        return text != nullptr ? text : scl_status_name(code);
    }

    /// For programs that compare with `std::errc`, as they do with errors of the operating system.
    std::error_condition default_error_condition(int code) const noexcept override {
        std::errc system = meaning(code).system;
        return system != std::errc{} ? system : std::error_condition(code, *this);
    }

  private:
    static Meaning meaning(int code) noexcept {
        for (const Meaning& meaning : meanings) {
            if (static_cast<int>(meaning.kind) == code) {
                return meaning;
            }
        }
        return {Errc::failed, nullptr, std::errc{}};
    }
};

/// Throws the exception class of a kind if it is one of these.
template <class... Classes> void raise_one_of(Errc kind, const std::string& text) {
    ((kind == Classes::kind ? throw Classes(text) : void()), ...);
}

/// Throws the exception class of a kind.
[[noreturn]] inline void raise(Errc kind, const std::string& text) {
    if (kind == Errc::stopped) {
        throw Stopped(text);
    }
    raise_one_of<Timeout, Full, PeerLost, Refused, RequesterGone, Taken, TooLong, DecodeError, EncodeError, NotFlushed>(
        kind, text);
    throw Error(kind, text);
}

/// Returns the status of a call. If the C library knows only the handle, sets a text that names the object.
inline scl_status named(scl_status status, const char* what, const std::string& name) {
    if (status != SCL_HANDLE && status != SCL_BUSY) {
        return status;
    }
    const char* reason = status == SCL_HANDLE ? "` is closed"
                                              : "` is in use by another thread; use each gate from one thread at a time";
    return scl_fail(status, (std::string(what) + " `" + name + reason).c_str());
}

/// Throws the exception of a status unless it is `SCL_OK`.
inline void check(scl_status status) {
    if (status != SCL_OK) {
        raise(static_cast<Errc>(status), scl_error());
    }
}

/// Throws if the library has a different version than the headers.
inline void check_library() {
    if (scl_abi() != SCL_ABI) {
        raise(Errc::failed, "this program was compiled with version " + std::to_string(SCL_ABI) +
                                " of SCL's interface but loaded a library of version " +
                                std::to_string(scl_abi()) + "; recompile it, or install the matching library");
    }
}

} // namespace detail

inline const std::error_category& error_category() noexcept {
    // Never destroyed: static objects may compare errors in their destructors.
    static const auto* category = new detail::Category;
    return *category;
}

} // namespace scl
