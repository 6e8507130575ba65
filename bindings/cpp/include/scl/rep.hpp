/// Gates that answer requests: `rep`.
#pragma once

#include <scl/gate.hpp>
#include <scl/log.hpp>
#include <scl/received_range.hpp>

#include <cstdint>
#include <memory>

namespace scl {

template <class A, class B, class Format> class Rep;

/// A request and its way back. It may be answered later than others, and by another thread than the one that received
/// it.
///
/// A request that is destroyed without an answer, for example by an exception, is noted in the log; its sender waits
/// until its timeout.
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
    /// Throws `RequesterGone` if nobody waits for the reply any more, which a replier may well ignore; `TooLong` if the
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
template <class A, class B, class Format = Native> class Rep : public Gate, public detail::Receives {
  public:
    using Request = scl::Request<A, B, Format>;

    Rep(const Component& component, const std::string& name) : Gate(component, name) {}
    Rep(Rep&&) noexcept = default;
    Rep& operator=(Rep&&) noexcept = default;

    /// Gives a gate of bytes message types and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<A, Bytes>, int> = 0>
    explicit Rep(Rep<Other, Other>&& bytes) noexcept : Gate(std::move(bytes)) {}

    /// Waits for the next request.
    ///
    /// Throws `Stopped` after a stop request, and `DecodeError` if the codec cannot read a request: its sender gets no
    /// reply, and the next call returns the next request.
    Request recv() {
        std::optional<Request> request;
        require(receive(request, TimeLimit::none()));
        return std::move(*request);
    }

    /// Waits for the next request no longer than `limit`. Returns nothing if none arrived in time.
    std::optional<Request> recv(TimeLimit limit) {
        std::optional<Request> request;
        require(receive(request, limit));
        return request;
    }

    /// Returns the next request if one has arrived.
    std::optional<Request> try_recv() { return recv(std::chrono::nanoseconds::zero()); }

    /// `recv` that reports errors as codes; it returns a request exactly if there is no error.
    std::optional<Request> recv(std::error_code& error) { return recv(TimeLimit::none(), error); }

    /// Nothing in time is no error.
    std::optional<Request> recv(TimeLimit limit, std::error_code& error) {
        std::optional<Request> request;
        detail::attempt(error, [&] { return receive(request, limit); });
        return request;
    }

    std::optional<Request> try_recv(std::error_code& error) { return recv(std::chrono::nanoseconds::zero(), error); }

    /// All requests, until a stop is requested or the component is closed: `for (auto& request : gate) { request.reply(...); }`.
    detail::ReceivedIterator<Rep> begin() { return detail::ReceivedIterator<Rep>(*this); }
    detail::ReceivedEnd end() const noexcept { return {}; }

  private:
    friend detail::ReceivedIterator<Rep>;
    using Received = Request;

    scl_status receive(std::optional<Request>& request, TimeLimit limit) const {
        std::int64_t timeout = limit.nanoseconds();
        scl_status status = SCL_OK;
        while (status == SCL_OK && !request) {
            scl_request* taken = nullptr;
            status = scl_take_request(handle(), timeout, &taken);
            if (status == SCL_OK) {
                request = Request::decode(typename Request::Handle(taken), handle(), name());
            }
            timeout = SCL_REST;
        }
        return status == SCL_NOTHING || status == SCL_TIMEOUT ? SCL_OK : told(status);
    }
};

} // namespace scl
