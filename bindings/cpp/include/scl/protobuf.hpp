/// The codec `protobuf`, using libprotobuf.
#pragma once

#include <scl/codec.hpp>

#include <google/protobuf/message_lite.h>

#include <limits>

namespace scl {

/// Protobuf messages. Fields that the receiver does not know are skipped.
template <class T> struct Codec<T, Native, std::enable_if_t<std::is_base_of_v<google::protobuf::MessageLite, T>>> {
    static BytesView encode(const T& message, std::string& buffer) {
        if (!message.IsInitialized()) {
            throw EncodeError("required fields are missing: " + message.InitializationErrorString());
        }
        std::size_t size = message.ByteSizeLong();
        if (size > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
            throw EncodeError("it is longer than 2 GiB, the longest protobuf message");
        }
        buffer.resize(size);
        message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(buffer.data()));
        return buffer;
    }

    static T decode(const Bytes& bytes) {
        T message;
        if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) ||
            !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
            throw DecodeError("these " + std::to_string(bytes.size()) + " bytes are not a protobuf message of type `" +
                              message.GetTypeName() + "`");
        }
        return message;
    }
};

} // namespace scl
