/// The codec `json` for protobuf messages, using libprotobuf.
#pragma once

#include <scl/codec.hpp>

#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/message.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <cstdlib>
#include <string>

namespace scl {

namespace detail {

/// Returns true for the name of an enum value, or its number as text.
inline bool is_enum_value(const google::protobuf::EnumDescriptor& values, const std::string& text) {
    if (values.FindValueByName(text) != nullptr) {
        return true;
    }
    if (text.empty() || text.size() > 11 || text.find_first_not_of("0123456789", text[0] == '-') != std::string::npos) {
        return false;
    }
    long long number = std::strtoll(text.c_str(), nullptr, 10);
    return number == static_cast<int>(number) && values.FindValueByNumber(static_cast<int>(number)) != nullptr;
}

/// Throws for names of enum values that the schema does not have. libprotobuf reads them as 0 when it skips unknown
/// fields.
inline void refuse_unknown_enum_values(const google::protobuf::Descriptor& type, const google::protobuf::Struct& object,
                                       const std::string& path);

inline void refuse_unknown_enum_values(const google::protobuf::FieldDescriptor& field,
                                       const google::protobuf::Value& value, const std::string& path) {
    if (value.has_list_value()) {
        for (const auto& item : value.list_value().values()) {
            refuse_unknown_enum_values(field, item, path);
        }
    } else if (field.message_type() != nullptr && value.has_struct_value()) {
        refuse_unknown_enum_values(*field.message_type(), value.struct_value(), path + ".");
    } else if (field.enum_type() != nullptr && value.kind_case() == google::protobuf::Value::kStringValue) {
        const std::string& name = value.string_value();
        if (!is_enum_value(*field.enum_type(), name)) {
            throw DecodeError("`" + name + "` of the field `" + path + "` is not a value of the enum `" +
                              std::string(field.enum_type()->full_name()) + "`");
        }
    }
}

inline void refuse_unknown_enum_values(const google::protobuf::Descriptor& type, const google::protobuf::Struct& object,
                                       const std::string& path) {
    if (std::string(type.full_name()).rfind("google.protobuf.", 0) == 0) {
        return;
    }
    if (type.options().map_entry()) {
        for (const auto& entry : object.fields()) {
            refuse_unknown_enum_values(*type.FindFieldByName("value"), entry.second, path + entry.first);
        }
        return;
    }
    for (int index = 0; index < type.field_count(); ++index) {
        const auto& field = *type.field(index);
        for (const std::string& key : {std::string(field.json_name()), std::string(field.name())}) {
            auto found = object.fields().find(key);
            if (found != object.fields().end()) {
                refuse_unknown_enum_values(field, found->second, path + std::string(field.name()));
            }
        }
    }
}

} // namespace detail

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
        std::string text = bytes.to_string();
        T message;
        auto status = google::protobuf::util::JsonStringToMessage(text, &message);
        if (status.ok()) {
            return message;
        }
        // Perhaps it has fields that this program does not know.
        google::protobuf::util::JsonParseOptions options;
        options.ignore_unknown_fields = true;
        message.Clear();
        status = google::protobuf::util::JsonStringToMessage(text, &message, options);
        google::protobuf::Struct object;
        if (status.ok()) {
            // Refuses a repeated name, of which only the last would be checked.
            status = google::protobuf::util::JsonStringToMessage(text, &object);
        }
        if (status.ok()) {
            detail::refuse_unknown_enum_values(*T::descriptor(), object, "");
        }
        if (!status.ok()) {
            throw DecodeError("it is not a JSON value of type `" + message.GetTypeName() + "`: " + status.ToString());
        }
        return message;
    }
};

} // namespace scl
