/// Codecs: encoding messages into bytes and decoding them. The codecs of bytes and plain structs are here; the ones
/// that need libprotobuf are in `scl/protobuf.hpp` and `scl/json.hpp`.
#pragma once

#include <scl/bytes.hpp>
#include <scl/error.hpp>

#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace scl {

/// The default format of a message type: protobuf for protobuf messages, unchanged bytes for bytes.
struct Native;
/// The bytes of a trivially copyable struct in memory, as `codec: raw` in the topology file.
struct Raw;
/// JSON, as `codec: json` in the topology file.
struct Json;

namespace detail {

template <class...> inline constexpr bool never = false;

} // namespace detail

/// Encodes and decodes messages of a type in a format. Specialise it for a type of your own:
///
///     template <> struct scl::Codec<Position> {
///         /// Returns the bytes to send: in `buffer`, which is empty and is reused, or in `position` itself.
///         static scl::BytesView encode(const Position& position, std::string& buffer);
///         static Position decode(scl::Bytes bytes);
///     };
///
/// Both report failures by throwing `scl::EncodeError` and `scl::DecodeError`, or any other exception.
template <class T, class Format = Native, class Enable = void> struct Codec {
    static_assert(detail::never<T>, "scl: no codec turns messages of this type into bytes. For a protobuf message "
                                    "include <scl/protobuf.hpp> (or <scl/json.hpp>); for a type of your own "
                                    "specialise scl::Codec, see docs/cpp.md, \"Codecs\"");
    static BytesView encode(const T& message, std::string& buffer);
    static T decode(Bytes bytes);
};

/// Bytes, received without a copy. Gates of `scl::Bytes` send any `scl::BytesView`.
template <class Format> struct Codec<Bytes, Format> {
    static BytesView encode(BytesView bytes, std::string&) noexcept { return bytes; }
    static Bytes decode(Bytes bytes) { return bytes; }
};

/// Text, or bytes in a string. With `codec: json` it is the JSON text of a type of another language.
template <class Format> struct Codec<std::string, Format> {
    static BytesView encode(const std::string& text, std::string&) noexcept { return text; }
    static std::string decode(const Bytes& bytes) { return bytes.to_string(); }
};

/// Bytes in a vector.
template <class Byte> struct Codec<std::vector<Byte>, Native, std::enable_if_t<detail::is_byte<Byte>>> {
    static BytesView encode(const std::vector<Byte>& bytes, std::string&) noexcept { return bytes; }

    static std::vector<Byte> decode(const Bytes& bytes) {
        std::vector<Byte> copy(bytes.size());
        if (!bytes.empty()) {
            std::memcpy(copy.data(), bytes.data(), bytes.size());
        }
        return copy;
    }
};

/// A struct of fixed layout as its bytes in memory. A message must be exactly as long as the struct.
template <class T> struct Codec<T, Raw, std::enable_if_t<std::is_class_v<T> && std::is_trivially_copyable_v<T>>> {
    static BytesView encode(const T& message, std::string&) noexcept { return {std::addressof(message), sizeof(T)}; }

    static T decode(const Bytes& bytes) {
        if (bytes.size() != sizeof(T)) {
            throw DecodeError("expected exactly " + std::to_string(sizeof(T)) + " bytes, received " +
                              std::to_string(bytes.size()));
        }
        T message;
        std::memcpy(&message, bytes.data(), sizeof(T));
        return message;
    }
};

namespace detail {

/// What a gate of `T` sends; at a gate of bytes, any bytes.
template <class T> using sent_t = std::conditional_t<std::is_same_v<T, Bytes>, BytesView, T>;

} // namespace detail

} // namespace scl
