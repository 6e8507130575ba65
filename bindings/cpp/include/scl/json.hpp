/// The codec `json` for protobuf messages, by libprotobuf.
#pragma once

#include <scl/codec.hpp>

#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

namespace scl {

/// Protobuf messages as canonical protobuf JSON, as in every other language. Fields that the receiver does not know are
/// skipped.
template <class T> struct Codec<T, Json, std::enable_if_t<std::is_base_of_v<google::protobuf::MessageLite, T>>> {
    static_assert(std::is_base_of_v<google::protobuf::Message, T>,
                  "scl: JSON needs the full protobuf runtime; remove `optimize_for = LITE_RUNTIME` from the schema");

    static BytesView encode(const T& message, std::string& buffer) {
        auto status = google::protobuf::util::MessageToJsonString(message, &buffer);
        if (!status.ok()) {
            throw EncodeError("JSON cannot represent its value: " + status.ToString());
        }
        return buffer;
    }

    static T decode(const Bytes& bytes) {
        google::protobuf::util::JsonParseOptions options;
        options.ignore_unknown_fields = true;
        T message;
        auto status = google::protobuf::util::JsonStringToMessage(bytes.to_string(), &message, options);
        if (!status.ok()) {
            throw DecodeError("it is not a JSON value of type `" + message.GetTypeName() + "`: " + status.ToString());
        }
        return message;
    }
};

} // namespace scl
