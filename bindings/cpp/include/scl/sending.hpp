/// Gates that send messages: `pub` and `push`.
#pragma once

#include <scl/gate.hpp>

namespace scl {

namespace detail {

template <class T, class Format> class SendingGate : public Gate {
  public:
    using Message = T;

    SendingGate(const Component& component, const std::string& name) : Gate(component, name) {}

    /// Sends a message. It waits only at a gate with `backpressure: true`, for a peer with `when_full: wait` whose
    /// queue is full.
    ///
    /// Throws `Stopped` after a stop request, `TooLong` if a peer does not accept messages of this length, and
    /// `EncodeError`.
    void send(const sent_t<T>& message) { require(transmit(message, TimeLimit::none())); }

    /// Sends a message, and throws `Full` if it would have to wait for longer than `limit`; then nothing was sent.
    void send(const sent_t<T>& message, TimeLimit limit) { require(transmit(message, limit)); }

    /// Sends a message unless it would have to wait. Returns whether it was sent.
    [[nodiscard]] bool try_send(const sent_t<T>& message) {
        scl_status status = transmit(message, std::chrono::nanoseconds::zero());
        if (status == SCL_FULL) {
            return false;
        }
        require(status);
        return true;
    }

    /// `send` that reports errors as codes. Returns whether the message was sent.
    bool send(const sent_t<T>& message, std::error_code& error) { return send(message, TimeLimit::none(), error); }

    bool send(const sent_t<T>& message, TimeLimit limit, std::error_code& error) {
        return attempt(error, [&] { return transmit(message, limit); });
    }

    template <class Other, class... More,
              std::enable_if_t<!std::is_convertible_v<const Other&, const sent_t<T>&>, int> = 0>
    void send(const Other&, More&&...) {
        static_assert(never<Other>, "scl: this gate sends messages of another type, the one in its declaration: "
                                    "`scl::Pub<Type>` or `scl::Push<Type>`");
    }

    template <class Other, std::enable_if_t<!std::is_convertible_v<const Other&, const sent_t<T>&>, int> = 0>
    bool try_send(const Other&) {
        static_assert(never<Other>, "scl: this gate sends messages of another type, the one in its declaration: "
                                    "`scl::Pub<Type>` or `scl::Push<Type>`");
        return false;
    }

  protected:
    explicit SendingGate(Gate&& gate) noexcept : Gate(std::move(gate)) {}

  private:
    scl_status transmit(const sent_t<T>& message, TimeLimit limit) const {
        scl_status status = encode<T, Format>(message, name(), [&](const void* data, std::size_t size) {
            return scl_send(handle(), data, size, limit.nanoseconds());
        });
        // With a limit, the C library reports a timeout; the reason is the same.
        return status == SCL_TIMEOUT ? SCL_FULL : told(status);
    }
};

} // namespace detail

/// Sends messages to all subscribers. Subscribers that start later or restart connect by themselves.
template <class T, class Format = Native> class Pub : public detail::SendingGate<T, Format> {
  public:
    using detail::SendingGate<T, Format>::SendingGate;

    /// Gives a gate of bytes a message type and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<T, Bytes>, int> = 0>
    explicit Pub(Pub<Other>&& bytes) noexcept : detail::SendingGate<T, Format>(static_cast<Gate&&>(bytes)) {}
};

/// Sends messages to a `pull` gate; with several (`share: true`), each message to one of them.
template <class T, class Format = Native> class Push : public detail::SendingGate<T, Format> {
  public:
    using detail::SendingGate<T, Format>::SendingGate;

    /// Gives a gate of bytes a message type and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<T, Bytes>, int> = 0>
    explicit Push(Push<Other>&& bytes) noexcept : detail::SendingGate<T, Format>(static_cast<Gate&&>(bytes)) {}
};

} // namespace scl
