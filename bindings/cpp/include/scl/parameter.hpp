/// The values of a component's parameters.
#pragma once

#include <scl.h>
#include <scl/component.hpp>
#include <scl/enumeration.hpp>
#include <scl/error.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace scl {
namespace detail {

inline void read_item(scl_component* component, const char* name, std::size_t index, bool& value) {
    check(scl_parameter_bool(component, name, index, &value));
}

template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
void read_item(scl_component* component, const char* name, std::size_t index, Integer& value) {
    using Widest = std::conditional_t<std::is_signed_v<Integer>, std::int64_t, std::uint64_t>;
    Widest found = 0;
    if constexpr (std::is_signed_v<Integer>) {
        check(scl_parameter_i64(component, name, index, &found));
    } else {
        check(scl_parameter_u64(component, name, index, &found));
    }
    if (found < std::numeric_limits<Integer>::min() || found > std::numeric_limits<Integer>::max()) {
        raise(Errc::kind, "parameter `" + std::string(name) + "` is " + std::to_string(found) +
                              ", which the type of the program cannot hold");
    }
    value = static_cast<Integer>(found);
}

inline void read_item(scl_component* component, const char* name, std::size_t index, double& value) {
    check(scl_parameter_f64(component, name, index, &value));
}

inline void read_item(scl_component* component, const char* name, std::size_t index, float& value) {
    double found = 0;
    check(scl_parameter_f64(component, name, index, &found));
    value = static_cast<float>(found);
}

inline void read_item(scl_component* component, const char* name, std::size_t index, std::string& value) {
    const char* found = nullptr;
    check(scl_parameter_text(component, name, index, &found));
    value = found;
}

inline void read_item(
    scl_component* component, const char* name, std::size_t index, std::chrono::nanoseconds& value) {
    std::uint64_t found = 0;
    check(scl_parameter_duration_ns(component, name, index, &found));
    // Longer ones, of more than 292 years, become the longest one.
    constexpr auto longest = static_cast<std::uint64_t>(std::chrono::nanoseconds::max().count());
    value = std::chrono::nanoseconds(static_cast<std::chrono::nanoseconds::rep>(std::min(found, longest)));
}

/// Reads a single value.
template <class T> void read_parameter(scl_component* component, const char* name, T& value) {
    read_item(component, name, 0, value);
}

/// Reads a list of any length.
template <class T> void read_parameter(scl_component* component, const char* name, std::vector<T>& values) {
    std::size_t count = 0;
    check(scl_parameter_count(component, name, &count));
    values.clear();
    for (std::size_t index = 0; index < count; ++index) {
        T value{};
        read_item(component, name, index, value);
        values.push_back(std::move(value));
    }
}

/// Reads a list of a fixed length.
template <class T, std::size_t Count>
void read_parameter(scl_component* component, const char* name, std::array<T, Count>& values) {
    for (std::size_t index = 0; index < Count; ++index) {
        read_item(component, name, index, values[index]);
    }
}

/// Reads one of several words, which the values of an enum stand for.
template <class Enum, std::size_t Count>
void read_choice(scl_component* component, const char* name, Enum& value, const char* const (&words)[Count]) {
    std::string word;
    read_item(component, name, 0, word);
    value = index_of<Enum>(word, words);
}

/// Takes over the live parameters that have changed, and waits for one. Returns whether any has.
inline bool update_parameters(const Component& component, TimeLimit limit) {
    bool changed = false;
    check(scl_update_parameters(component.handle(), limit.nanoseconds(), &changed));
    return changed;
}

} // namespace detail

/// The value that a parameter had when the component was opened, or at the last `update_parameters`. `T` is `bool`, an integer, `float`, `double`,
/// `std::string` for texts and words of a choice, `std::chrono::nanoseconds`, or a `std::vector` or `std::array` of
/// them. Components that `scl generate --for cpp` writes have the member `parameters`.
///
/// Throws `Error` if the component has no such parameter (`Errc::name`), or it is of another type (`Errc::kind`).
template <class T> T parameter(const Component& component, const std::string& name) {
    T value{};
    detail::read_parameter(component.handle(), name.c_str(), value);
    return value;
}

} // namespace scl
