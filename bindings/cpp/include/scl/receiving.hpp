/// Gates that receive messages: `sub` and `pull`.
#pragma once

#include <scl/enumeration.hpp>
#include <scl/receiver.hpp>

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace scl {

namespace detail {

template <class T, class Format> class ReceivingGate : public Receiver<ReceivingGate<T, Format>, T> {
    using Base = Receiver<ReceivingGate<T, Format>, T>;

  public:
    using Message = T;

    ReceivingGate(const Component& component, const std::string& name) : Base(component, name) {}

    /// Returns the newest message that has arrived, if any and if the codec can read it, and discards the older ones.
    std::optional<T> latest() {
        std::optional<T> message;
        this->require(receive_latest(message));
        return message;
    }

    std::optional<T> latest(std::error_code& error) {
        std::optional<T> message;
        attempt(error, [&] { return receive_latest(message); });
        return message;
    }

    /// How many messages the gate has missed since the last call: its `deadline` passed without one. It does not wait.
    /// Each is told once. Throws `Error` (`Errc::failed`) if the gate declares no `deadline`.
    std::uint64_t take_missed() {
        std::uint64_t missed = 0;
        this->require(this->told(scl_take_missed(this->handle(), &missed)));
        return missed;
    }

    std::uint64_t take_missed(std::error_code& error) {
        std::uint64_t missed = 0;
        attempt(error, [&] { return this->told(scl_take_missed(this->handle(), &missed)); });
        return missed;
    }

  protected:
    explicit ReceivingGate(Gate&& gate) noexcept : Base(std::move(gate)) {}

  private:
    friend Base;

    scl_status receive_one(std::optional<T>& message, std::int64_t timeout) const {
        scl_message* received = nullptr;
        scl_status status = scl_recv(this->handle(), timeout, &received);
        take(message, status, received);
        return status;
    }

    scl_status receive_latest(std::optional<T>& message) const {
        scl_message* received = nullptr;
        scl_status status = scl_latest(this->handle(), &received);
        take(message, status, received);
        return this->nothing_is_ok(status);
    }

    /// Stores the message unless it is to be skipped.
    void take(std::optional<T>& message, scl_status status, scl_message* received) const {
        if (status == SCL_OK) {
            message = decode<T, Format>([&] { return Bytes(received); }, this->handle());
        }
    }
};

} // namespace detail

/// Receives messages from one or several publishers, in order of arrival.
template <class T, class Format = Native> class Sub : public detail::ReceivingGate<T, Format> {
  public:
    using detail::ReceivingGate<T, Format>::ReceivingGate;

    /// Gives a gate of bytes a message type and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<T, Bytes>, int> = 0>
    explicit Sub(Sub<Other>&& bytes) noexcept : detail::ReceivingGate<T, Format>(static_cast<Gate&&>(bytes)) {}

    /// The age of the message that the last call returned, if its publisher has `latched: true` and had sent it before
    /// this gate was connected to it; nothing for every other message.
    std::optional<std::chrono::nanoseconds> latched_age() const noexcept {
        const std::int64_t age = scl_latched_age(this->handle());
        return age < 0 ? std::nullopt : std::optional(std::chrono::nanoseconds(age));
    }

    /// The gate that sent the message that the last call returned, as `component.gate`: its connection tells. Empty
    /// before the first message.
    std::string_view sender() const noexcept {
        const char* sender = scl_sender(this->handle());
        return sender == nullptr ? std::string_view() : std::string_view(sender);
    }
};

/// A `sub` gate whose senders a program tells apart by an enum. `Senders` has the enum, `Sender`, and `names`, the gates
/// that its values stand for, in their order; generated code contains it.
template <class Base, class Senders> class From : public Base {
  public:
    using Sender = typename Senders::Sender;
    using typename Base::Message;

    using Base::Base;

    /// `recv` that also returns who sent the message: its connection tells, so nothing is added to the message.
    std::pair<Sender, Message> recv_from() {
        Message message = this->recv();
        return {last(), std::move(message)};
    }

    /// The same with a time limit. Returns nothing if no message has arrived in time.
    std::optional<std::pair<Sender, Message>> recv_from(TimeLimit limit) {
        std::optional<Message> message = this->recv(limit);
        if (!message) {
            return std::nullopt;
        }
        return std::pair<Sender, Message>(last(), std::move(*message));
    }

    /// Who sent the message that the last call returned, whichever call that was; nothing before the first one.
    std::optional<Sender> sender() const noexcept {
        return Base::sender().empty() ? std::nullopt : std::optional<Sender>(last());
    }

  private:
    Sender last() const noexcept { return detail::index_of<Sender>(Base::sender(), Senders::names); }
};

/// Receives messages from any number of `push` gates, in order of arrival.
template <class T, class Format = Native> class Pull : public detail::ReceivingGate<T, Format> {
  public:
    using detail::ReceivingGate<T, Format>::ReceivingGate;

    /// Gives a gate of bytes a message type and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<T, Bytes>, int> = 0>
    explicit Pull(Pull<Other>&& bytes) noexcept : detail::ReceivingGate<T, Format>(static_cast<Gate&&>(bytes)) {}
};

} // namespace scl
