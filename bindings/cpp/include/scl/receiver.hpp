/// Gates that receive messages or requests.
#pragma once

#include <scl/gate.hpp>
#include <scl/received_range.hpp>

#include <cstdint>

namespace scl::detail {

/// The base of all gates that receive messages or requests. `Kind` has `receive_one`, which receives an `Item`.
template <class Kind, class Item> class Receiver : public Gate, public Receives {
  public:
    /// Waits for the next message or request. At a gate with `queue: 1` a message is always the newest one.
    ///
    /// Messages that the codec cannot read are counted and skipped; a gate with `undecodable: fail` throws
    /// `DecodeError`, and the next call returns the next message. The call of a requester that sent one fails
    /// with `Refused`. Throws
    /// `Stopped` after a stop request.
    Item recv() {
        std::optional<Item> received;
        require(receive(received, TimeLimit::none()));
        return std::move(*received);
    }

    /// Waits no longer than `limit`. Returns nothing if none arrived in time.
    std::optional<Item> recv(TimeLimit limit) {
        std::optional<Item> received;
        require(receive(received, limit));
        return received;
    }

    /// Returns the next message or request if one has arrived.
    std::optional<Item> try_recv() { return recv(std::chrono::nanoseconds::zero()); }

    /// `recv` that reports errors as codes; it returns a value exactly if there is no error.
    std::optional<Item> recv(std::error_code& error) { return recv(TimeLimit::none(), error); }

    /// It is not an error if nothing arrives in time.
    std::optional<Item> recv(TimeLimit limit, std::error_code& error) {
        std::optional<Item> received;
        attempt(error, [&] { return receive(received, limit); });
        return received;
    }

    std::optional<Item> try_recv(std::error_code& error) { return recv(std::chrono::nanoseconds::zero(), error); }

    /// All messages or requests, until a stop is requested or the component is closed: `for (auto& message : gate)`.
    ReceivedIterator<Receiver> begin() { return ReceivedIterator<Receiver>(*this); }
    ReceivedEnd end() const noexcept { return {}; }

  protected:
    Receiver(const Component& component, const std::string& name) : Gate(component, name) {}
    explicit Receiver(Gate&& gate) noexcept : Gate(std::move(gate)) {}

    scl_status nothing_is_ok(scl_status status) const {
        return status == SCL_NOTHING || status == SCL_TIMEOUT ? SCL_OK : told(status);
    }

  private:
    friend ReceivedIterator<Receiver>;
    using Received = Item;

    scl_status receive(std::optional<Item>& received, TimeLimit limit) const {
        std::int64_t timeout = limit.nanoseconds();
        scl_status status = SCL_OK;
        // Until an item is not skipped.
        while (status == SCL_OK && !received) {
            status = static_cast<const Kind&>(*this).receive_one(received, timeout);
            timeout = SCL_REST;
        }
        return nothing_is_ok(status);
    }
};

} // namespace scl::detail
