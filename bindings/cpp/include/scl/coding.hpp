/// Encoding and decoding for a gate, and calls that report errors as codes.
#pragma once

#include <scl/codec.hpp>
#include <scl/error.hpp>

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>

namespace scl::detail {

/// Encodes a message and passes its bytes to `use`. Their memory belongs to the thread and is reused, up to 1 MiB.
template <class T, class Format, class Use>
scl_status encode(const sent_t<T>& message, const std::string& gate, Use&& use) {
    constexpr std::size_t kept = 1 << 20;
    thread_local std::string spare;
    // Taken, because a codec may itself send through another gate.
    std::string buffer = std::move(spare);
    buffer.clear();
    BytesView bytes;
    try {
        bytes = Codec<T, Format>::encode(message, buffer);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw EncodeError("gate `" + gate + "` cannot encode this message: " + error.what());
    }
    scl_status status = use(bytes.data(), bytes.size());
    if (buffer.capacity() <= kept) {
        spare = std::move(buffer);
    }
    return status;
}

/// Decodes a message that a gate received, by `Codec<T, Format>::decode(bytes)`. If that fails, the gate counts it.
template <class T, class Format, class Source> T decode(Source&& bytes, scl_gate* handle, const std::string& gate) {
    try {
        return Codec<T, Format>::decode(bytes());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        // Its own text does not say what the codec found.
        scl_undecodable(handle, "message");
        throw DecodeError("gate `" + gate + "` received an undecodable message: " + error.what());
    }
}

/// Makes a call that returns a status or throws an error of a codec, and stores either as a code. Returns whether there
/// was none.
template <class Call> bool attempt(std::error_code& error, Call&& call) {
    try {
        scl_status status = call();
        own_error().clear();
        if (status == SCL_OK) {
            error.clear();
            return true;
        }
        error = static_cast<Errc>(status);
    } catch (const Error& codec) {
        error = codec.code();
        own_error() = codec.what();
    }
    return false;
}

} // namespace scl::detail
