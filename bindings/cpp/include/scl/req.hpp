/// Gates that send requests: `req`.
#pragma once

#include <scl/gate.hpp>

namespace scl {

/// Sends requests of type `A` to a `rep` gate and receives replies of type `B`, one at a time: a gate serves one
/// thread, even with `in_flight`. For several calls at once, declare several gates.
template <class A, class B, class Format = Native> class Req : public Gate {
  public:
    using Request = A;
    using Reply = B;

    Req(const Component& component, const std::string& name) : Gate(component, name) {}

    /// Gives a gate of bytes message types and a codec of the program's own.
    template <class Other, std::enable_if_t<std::is_same_v<Other, Bytes> && !std::is_same_v<A, Bytes>, int> = 0>
    explicit Req(Req<Other, Other>&& bytes) noexcept : Gate(std::move(bytes)) {}

    /// Sends a request and waits for the reply, together no longer than the `timeout` of the gate in the topology file.
    /// Within that time, it waits for a replier that is not connected yet or restarts.
    ///
    /// Throws `Timeout`, `PeerLost` if the replier disconnected after the request was sent, `Refused` if it could not
    /// decode the request, `TooLong`, `EncodeError`, `DecodeError`, and `Stopped` after a stop request. Whatever it
    /// throws, the next call starts afresh.
    B call(const detail::sent_t<A>& request) { return call(request, TimeLimit::none()); }

    /// `call` with a shorter time limit.
    B call(const detail::sent_t<A>& request, TimeLimit limit) {
        std::optional<B> reply;
        require(exchange(request, limit, reply));
        return std::move(*reply);
    }

    /// `call` that reports errors as codes; it returns a reply exactly if there is no error.
    std::optional<B> call(const detail::sent_t<A>& request, std::error_code& error) {
        return call(request, TimeLimit::none(), error);
    }

    std::optional<B> call(const detail::sent_t<A>& request, TimeLimit limit, std::error_code& error) {
        std::optional<B> reply;
        detail::attempt(error, [&] { return exchange(request, limit, reply); });
        return reply;
    }

    template <class Other, class... More,
              std::enable_if_t<!std::is_convertible_v<const Other&, const detail::sent_t<A>&>, int> = 0>
    B call(const Other&, More&&...) {
        static_assert(detail::never<Other>, "scl: the requests of this gate are of another type, the first one in its "
                                            "declaration: `scl::Req<Request, Reply>`");
    }

  private:
    scl_status exchange(const detail::sent_t<A>& request, TimeLimit limit, std::optional<B>& reply) const {
        scl_message* received = nullptr;
        scl_status status = detail::encode<A, Format>(request, name(), [&](const void* data, std::size_t size) {
            return scl_call(handle(), data, size, limit.nanoseconds(), &received);
        });
        if (status == SCL_OK) {
            reply = detail::decode<B, Format>([&] { return Bytes(received); }, handle());
        }
        return status == SCL_NOTHING ? SCL_TIMEOUT : told(status);
    }
};

} // namespace scl
