/// Gates that answer requests: `rep`.
#pragma once

#include <scl/log.hpp>
#include <scl/receiver.hpp>

#include <cstdint>
#include <memory>

namespace scl {

template <class A, class B, class Format> class Rep;

/// A request and the way back to its sender. It may be answered later than others, and by a different thread than the
/// one that received it.
///
/// If a request is destroyed without an answer, for example by an exception, that is logged; its sender waits until its
/// timeout.
template <class A, class B, class Format = Native> class Request {
  public:
    Request(Request&&) = default;
    Request& operator=(Request&&) = default;

    ~Request() {
        if (handle_ != nullptr) {
            detail::log_warning("gate `" + gate_ + "` did not answer a request; its sender waits until its timeout");
        }
    }

    const A& message() const noexcept { return message_; }
    const A& operator*() const noexcept { return message_; }
    const A* operator->() const noexcept { return std::addressof(message_); }

    /// Sends the reply. It never waits. A request is answered once: the next call throws `Error` (`Errc::handle`).
    ///
    /// Throws `RequesterGone` if the requester no longer waits, which a replier may well ignore; `TooLong` if the
    /// requester does not accept a reply of this length; and `EncodeError`, after which another reply may be
    /// sent, unless it says that a text is not UTF-8.
    void reply(const detail::sent_t<B>& reply) {
        require_unanswered();
        detail::check(transmit(reply));
    }

    /// `reply` that reports errors as codes. Returns whether the reply was sent.
    bool reply(const detail::sent_t<B>& reply, std::error_code& error) {
        return detail::attempt(error, [&] {
            require_unanswered();
            return transmit(reply);
        });
    }

    template <class Other, class... More,
              std::enable_if_t<!std::is_convertible_v<const Other&, const detail::sent_t<B>&>, int> = 0>
    void reply(const Other&, More&&...) {
        static_assert(detail::never<Other>, "scl: the replies of this gate are of another type, the second one in its "
                                            "declaration: `scl::Rep<Request, Reply>`");
    }

  private:
    friend class Rep<A, B, Format>;

    struct Free {
        void operator()(scl_request* request) const noexcept { scl_request_free(request); }
    };

    using Handle = std::unique_ptr<scl_request, Free>;

    Request(Handle handle, A message, const std::string& gate)
        : handle_(std::move(handle)), message_(std::move(message)), gate_(gate) {}

    /// Decodes a request. Returns nothing if it is to be skipped.
    static std::optional<Request> decode(Handle handle, scl_gate* receiver, const std::string& gate) {
        std::size_t size = 0;
        const void* data = scl_request_data(handle.get(), &size);
        std::optional<A> message;
        try {
            message = detail::decode<A, Format>([&] { return Bytes::borrowed(data, size); }, receiver, handle.get());
        } catch (const DecodeError&) {
            // It was freed when it was reported.
            static_cast<void>(handle.release());
            throw;
        }
        if (!message) {
            static_cast<void>(handle.release());
            return std::nullopt;
        }
        return Request(std::move(handle), std::move(*message), gate);
    }

    void require_unanswered() const {
        if (handle_ == nullptr) {
            throw Error(Errc::handle, "this request of gate `" + gate_ + "` was answered, or moved to another object");
        }
    }

    scl_status transmit(const detail::sent_t<B>& reply) {
        return detail::encode<B, Format>(reply, gate_, [&](const void* data, std::size_t size) {
            // The C library frees the request, whether the reply could be sent or not.
            return scl_reply(handle_.release(), data, size);
        });
    }

    Handle handle_;
    A message_;
    std::string gate_;
};

/// Answers requests of type `A` from any number of `req` gates with replies of type `B`.
template <class A, class B, class Format = Native>
class Rep : public detail::Receiver<Rep<A, B, Format>, Request<A, B, Format>> {
    using Base = detail::Receiver<Rep<A, B, Format>, scl::Request<A, B, Format>>;

  public:
    using Request = scl::Request<A, B, Format>;

    Rep(const Component& component, const std::string& name) : Base(component, name) {}

    /// Gives a gate of bytes message types and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<A, Bytes>, int> = 0>
    explicit Rep(Rep<Other, Other>&& bytes) noexcept : Base(static_cast<Gate&&>(bytes)) {}

  private:
    friend Base;

    scl_status receive_one(std::optional<Request>& request, std::int64_t timeout) const {
        scl_request* taken = nullptr;
        scl_status status = scl_take_request(this->handle(), timeout, &taken);
        if (status == SCL_OK) {
            request = Request::decode(typename Request::Handle(taken), this->handle(), this->name());
        }
        return status;
    }
};

} // namespace scl
