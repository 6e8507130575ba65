/// Waiting for several gates at once.
#pragma once

#include <scl/gate.hpp>
#include <scl/received_range.hpp>

#include <bitset>
#include <cstdint>

namespace scl {

namespace detail {

template <class... Gates>
scl_status wait(TimeLimit limit, std::bitset<sizeof...(Gates)>& ready, const Gates&... gates) {
    static_assert(sizeof...(Gates) > 0 && sizeof...(Gates) <= 64, "scl: `wait` takes 1 to 64 gates");
    static_assert((std::is_base_of_v<Gate, Gates> && ...), "scl: `wait` takes gates of one component");
    static_assert(((!std::is_base_of_v<Gate, Gates> || std::is_base_of_v<Receives, Gates>)&&...),
                  "scl: one of these gates does not receive, so `wait` cannot wait for it; only `sub`, `pull` and `rep` gates "
                  "do. The topology file says which kind a gate is");
    scl_gate* handles[] = {gates.handle()...};
    scl_component* components[] = {gates.component()...};
    const std::string* names[] = {&gates.name()...};
    std::uint64_t bits = 0;
    scl_status status = scl_wait(components[0], handles, sizeof...(Gates), limit.nanoseconds(), &bits);
    ready = std::bitset<sizeof...(Gates)>(bits);
    if (status == SCL_HANDLE) {
        // The component is closed, and with it all its gates.
        return named(status, "gate", *names[0]);
    }
    return status == SCL_TIMEOUT || status == SCL_NOTHING ? SCL_OK : status;
}

} // namespace detail

/// Waits until at least one of the gates has something to receive, and returns which: bit 0 is the first gate. No bit
/// is set if `limit` expires.
///
/// The gates belong to one component. Throws `Stopped` after a stop request.
template <class... Gates> std::bitset<sizeof...(Gates)> wait(TimeLimit limit, const Gates&... gates) {
    std::bitset<sizeof...(Gates)> ready;
    detail::check(detail::wait(limit, ready, gates...));
    return ready;
}

/// `wait` without a time limit.
template <class... Gates, std::enable_if_t<(std::is_base_of_v<Gate, Gates> && ...), int> = 0>
std::bitset<sizeof...(Gates)> wait(const Gates&... gates) {
    return wait(TimeLimit::none(), gates...);
}

/// `wait` that reports errors as codes.
template <class... Gates>
std::bitset<sizeof...(Gates)> wait(TimeLimit limit, std::error_code& error, const Gates&... gates) {
    std::bitset<sizeof...(Gates)> ready;
    detail::attempt(error, [&] { return detail::wait(limit, ready, gates...); });
    return ready;
}

} // namespace scl
