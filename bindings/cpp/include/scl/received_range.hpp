/// Range-based `for` over what a gate receives.
#pragma once

#include <scl.h>
#include <scl/time.hpp>

#include <cstddef>
#include <iterator>
#include <optional>

namespace scl::detail {

/// A base of all gates that receive messages or requests.
struct Receives {};

/// The end of a range of received messages: a stop request, or a closed component.
struct ReceivedEnd {};

/// An input iterator that holds one message at a time.
template <class Gate> class ReceivedIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = typename Gate::Received;
    using difference_type = std::ptrdiff_t;
    using pointer = value_type*;
    using reference = value_type&;

    explicit ReceivedIterator(Gate& gate) : gate_(&gate) { next(); }

    reference operator*() noexcept { return *message_; }
    pointer operator->() noexcept { return &*message_; }

    ReceivedIterator& operator++() {
        next();
        return *this;
    }

    friend bool operator==(const ReceivedIterator& iterator, ReceivedEnd) noexcept { return !iterator.message_; }
    friend bool operator!=(const ReceivedIterator& iterator, ReceivedEnd end) noexcept { return !(iterator == end); }

  private:
    void next() {
        // First, so that an unanswered request is given up before the next one is awaited.
        message_.reset();
        scl_status status = gate_->receive(message_, TimeLimit::none());
        if (status != SCL_STOPPED && status != SCL_CLOSED && status != SCL_HANDLE) {
            gate_->require(status);
        }
    }

    Gate* gate_;
    std::optional<value_type> message_;
};

} // namespace scl::detail
