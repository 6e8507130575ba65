/// Gates that receive messages: `sub` and `pull`.
#pragma once

#include <scl/gate.hpp>
#include <scl/received_range.hpp>

namespace scl {

namespace detail {

template <class T, class Format> class ReceivingGate : public Gate {
  public:
    using Message = T;

    ReceivingGate(const Component& component, const std::string& name) : Gate(component, name) {}

    /// Waits for the next message. At a gate with `queue: 1` this is always the newest one.
    ///
    /// Throws `Stopped` after a stop request, and `DecodeError` if the codec cannot read a message; the next call
    /// returns the next message.
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

    /// Returns the newest message that has arrived, if any, and discards the older ones.
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

    /// All messages, until a stop is requested: `for (auto& message : gate)`.
    ReceivedIterator<ReceivingGate> begin() { return ReceivedIterator<ReceivingGate>(*this); }
    ReceivedEnd end() const noexcept { return {}; }

  protected:
    explicit ReceivingGate(Gate&& gate) noexcept : Gate(std::move(gate)) {}

  private:
    friend ReceivedIterator<ReceivingGate>;
    using Received = T;

    scl_status receive(std::optional<T>& message, TimeLimit limit) const {
        scl_message* received = nullptr;
        scl_status status = scl_recv(handle(), limit.nanoseconds(), &received);
        return take(message, status, received);
    }

    scl_status receive_latest(std::optional<T>& message) const {
        scl_message* received = nullptr;
        scl_status status = scl_latest(handle(), &received);
        return take(message, status, received);
    }

    scl_status take(std::optional<T>& message, scl_status status, scl_message* received) const {
        if (status == SCL_OK) {
            message.emplace(decode<T, Format>([&] { return Bytes(received); }, handle(), name()));
        }
        return status == SCL_NOTHING || status == SCL_TIMEOUT ? SCL_OK : status;
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
