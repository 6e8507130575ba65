/// Enums whose values stand for names: the components of a kind, and the senders of a gate.
#pragma once

#include <scl/error.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace scl {
namespace detail {

/// The name of a component of a kind.
template <class Enum, std::size_t Count> const char* name_of(Enum value, const char* const (&names)[Count]) {
    const auto index = static_cast<std::size_t>(value);
    if (index >= Count) {
        raise(Errc::argument, "the instance is not one of the kind");
    }
    return names[index];
}

/// The value that stands for a name, which is one of these.
template <class Enum, std::size_t Count>
Enum index_of(std::string_view name, const char* const (&names)[Count]) noexcept {
    return static_cast<Enum>(std::find(std::begin(names), std::end(names), name) - std::begin(names));
}

} // namespace detail
} // namespace scl
