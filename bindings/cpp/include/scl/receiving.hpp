/// Gates that receive messages: `sub` and `pull`.
#pragma once

#include <scl/gate.hpp>
#include <scl/received_range.hpp>

#include <cstdint>

namespace scl {

namespace detail {

template <class T, class Format> class ReceivingGate : public Gate, public Receives {
  public:
    using Message = T;

    ReceivingGate(const Component& component, const std::string& name) : Gate(component, name) {}

    /// Waits for the next message. At a gate with `queue: 1` this is always the newest one.
    ///
    /// A message that the codec cannot read is counted and skipped; a gate with `undecodable: fail` throws `DecodeError`,
    /// and the next call returns the next message. Throws `Stopped` after a stop request.
    T recv() {
        std::optional<T> message;
        require(receive(message, TimeLimit::none()));
        return std::move(*message);
    }

    /// Waits for the next message no longer than `limit`. Returns nothing if none arrived in time.
    std::optional<T> recv(TimeLimit limit) {
        std::optional<T> message;
        require(receive(message, limit));
        return message;
    }

    /// Returns the next message if one has arrived.
    std::optional<T> try_recv() { return recv(std::chrono::nanoseconds::zero()); }

    /// Returns the newest message that has arrived, if any and if the codec can read it, and discards the older ones.
    std::optional<T> latest() {
        std::optional<T> message;
        require(receive_latest(message));
        return message;
    }

    /// `recv` that reports errors as codes; it returns a message exactly if there is no error.
    std::optional<T> recv(std::error_code& error) { return recv(TimeLimit::none(), error); }

    /// Nothing in time is no error.
    std::optional<T> recv(TimeLimit limit, std::error_code& error) {
        std::optional<T> message;
        attempt(error, [&] { return receive(message, limit); });
        return message;
    }

    std::optional<T> try_recv(std::error_code& error) { return recv(std::chrono::nanoseconds::zero(), error); }

    std::optional<T> latest(std::error_code& error) {
        std::optional<T> message;
        attempt(error, [&] { return receive_latest(message); });
        return message;
    }

    /// All messages, until a stop is requested or the component is closed: `for (auto& message : gate)`.
    ReceivedIterator<ReceivingGate> begin() { return ReceivedIterator<ReceivingGate>(*this); }
    ReceivedEnd end() const noexcept { return {}; }

  protected:
    explicit ReceivingGate(Gate&& gate) noexcept : Gate(std::move(gate)) {}

  private:
    friend ReceivedIterator<ReceivingGate>;
    using Received = T;

    scl_status receive(std::optional<T>& message, TimeLimit limit) const {
        std::int64_t timeout = limit.nanoseconds();
        scl_status status = SCL_OK;
        while (status == SCL_OK && !message) {
            scl_message* received = nullptr;
            status = scl_recv(handle(), timeout, &received);
            take(message, status, received);
            timeout = SCL_REST;
        }
        return nothing_is_ok(status);
    }

    scl_status receive_latest(std::optional<T>& message) const {
        scl_message* received = nullptr;
        scl_status status = scl_latest(handle(), &received);
        take(message, status, received);
        return nothing_is_ok(status);
    }

    /// Stores the message unless it is to be skipped.
    void take(std::optional<T>& message, scl_status status, scl_message* received) const {
        if (status == SCL_OK) {
            message = decode<T, Format>([&] { return Bytes(received); }, handle());
        }
    }

    scl_status nothing_is_ok(scl_status status) const {
        return status == SCL_NOTHING || status == SCL_TIMEOUT ? SCL_OK : told(status);
    }
};

} // namespace detail

/// Receives messages from one or several publishers, in order of arrival.
template <class T, class Format = Native> class Sub : public detail::ReceivingGate<T, Format> {
  public:
    using detail::ReceivingGate<T, Format>::ReceivingGate;
    Sub(Sub&&) noexcept = default;
    Sub& operator=(Sub&&) noexcept = default;

    /// Gives a gate of bytes a message type and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<T, Bytes>, int> = 0>
    explicit Sub(Sub<Other>&& bytes) noexcept : detail::ReceivingGate<T, Format>(static_cast<Gate&&>(bytes)) {}

    /// How old the message is that the last call returned, if its publisher has `latched: true` and had sent it before this
    /// gate was connected to it; nothing for every other message.
    std::optional<std::chrono::nanoseconds> latched_age() const noexcept {
        const std::int64_t age = scl_latched_age(this->handle());
        return age < 0 ? std::nullopt : std::optional(std::chrono::nanoseconds(age));
    }
};

/// Receives messages from any number of `push` gates, in order of arrival.
template <class T, class Format = Native> class Pull : public detail::ReceivingGate<T, Format> {
  public:
    using detail::ReceivingGate<T, Format>::ReceivingGate;
    Pull(Pull&&) noexcept = default;
    Pull& operator=(Pull&&) noexcept = default;

    /// Gives a gate of bytes a message type and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<T, Bytes>, int> = 0>
    explicit Pull(Pull<Other>&& bytes) noexcept : detail::ReceivingGate<T, Format>(static_cast<Gate&&>(bytes)) {}
};

} // namespace scl
