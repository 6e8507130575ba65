/// Encoding and decoding for a gate, and calls that report errors as codes.
#pragma once

#include <scl/codec.hpp>
#include <scl/error.hpp>

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace scl::detail {

/// The thread's buffer for the next message, or nullptr once the thread-local objects are destroyed: static objects may
/// send in their destructors.
inline std::string* spare_memory() noexcept {
    thread_local bool is_destroyed = false;
    struct Memory {
        std::string text;
        ~Memory() { is_destroyed = true; }
    };
    if (is_destroyed) {
        return nullptr;
    }
    thread_local Memory memory;
    return &memory.text;
}

/// Encodes a message and passes its bytes to `use`. Their memory belongs to the thread and is reused, up to 1 MiB.
template <class T, class Format, class Use>
scl_status encode(const sent_t<T>& message, const std::string& gate, Use&& use) {
    constexpr std::size_t kept = 1 << 20;
    std::string buffer;
    if (std::string* spare = spare_memory()) {
        // Moved out, because a codec may itself send through another gate.
        buffer = std::move(*spare);
        buffer.clear();
    }
    BytesView bytes;
    try {
        bytes = Codec<T, Format>::encode(message, buffer);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw EncodeError("gate `" + gate + "` cannot encode this message: " + error.what());
    }
    scl_status status = use(bytes.data(), bytes.size());
    if (std::string* spare = spare_memory(); spare != nullptr && buffer.capacity() <= kept) {
        *spare = std::move(buffer);
    }
    return status;
}

/// Decodes a received message with `Codec<T, Format>::decode(bytes)`. Reports a failure to the gate, with `request` if
/// the message is a request. Returns nothing if the message is to be skipped.
template <class T, class Format, class Source>
std::optional<T> decode(Source&& bytes, scl_gate* handle, scl_request* request = nullptr) {
    try {
        return Codec<T, Format>::decode(bytes());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        if (scl_undecodable(handle, request, error.what()) != SCL_OK) {
            throw DecodeError(scl_error());
        }
        return std::nullopt;
    }
}

/// Makes a call that returns a status or throws an error of a codec, which may itself use gates, and stores either as a
/// code. Returns true if there was no error.
template <class Call> bool attempt(std::error_code& error, Call&& call) {
    try {
        scl_status status = call();
        if (status == SCL_OK) {
            error.clear();
            return true;
        }
        error = static_cast<Errc>(status);
    } catch (const Error& codec) {
        error = codec.code();
        // The C library keeps the texts of this thread.
        scl_fail(error.value(), codec.what());
    } catch (const Stopped& codec) {
        error = codec.code();
        scl_fail(error.value(), codec.what());
    }
    return false;
}

} // namespace scl::detail
