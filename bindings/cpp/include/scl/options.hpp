/// Options for opening a component.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace scl {

/// Options for opening a component. Unset options come from the environment.
struct Options {
    /// The runtime folder; default: `SCL_RUNTIME_DIR`.
    std::optional<std::string> runtime_dir;
    /// The name of the system; default: `SCL_SYSTEM`, or the name in the topology file.
    std::optional<std::string> system;
    /// `ipc`, `tcp` or `shm`, or a list with exceptions for single connections, like `ipc,camera.frames=shm`; default:
    /// `SCL_TRANSPORT`.
    std::optional<std::string> transport;
    /// Whether SIGTERM and Ctrl-C request a stop, and an uncaught `scl::Error` ends the program with a message and an
    /// exit code instead of `abort`.
    bool signals = true;
    /// Values of parameters, as texts like in the topology file: `{{"controller.period", "10ms"}}`. They count more than
    /// those in `SCL_SET`, and those of other components have no effect.
    std::map<std::string, std::string> set = {};

    /// The options as JSON for the C interface.
    std::string to_json() const {
        std::string json = signals ? R"({"signals":true)" : R"({"signals":false)";
        append(json, "runtime_dir", runtime_dir);
        append(json, "system", system);
        append(json, "transport", transport);
        const char* before = ",\"set\":{";
        for (const auto& [parameter, value] : set) {
            append_text(json.append(before), parameter);
            append_text(json.append(":"), value);
            before = ",";
        }
        return json + (set.empty() ? "}" : "}}");
    }

  private:
    static void append(std::string& json, const char* key, const std::optional<std::string>& value) {
        if (!value) {
            return;
        }
        json.append(",\"").append(key).append("\":");
        append_text(json, *value);
    }

    static void append_text(std::string& json, std::string_view text) {
        json.push_back('"');
        for (char letter : text) {
            if (letter == '"' || letter == '\\') {
                json.push_back('\\');
                json.push_back(letter);
            } else if (static_cast<unsigned char>(letter) < 0x20) {
                constexpr std::string_view digits = "0123456789abcdef";
                json.append("\\u00").push_back(digits[static_cast<unsigned char>(letter) >> 4]);
                json.push_back(digits[letter & 15]);
            } else {
                json.push_back(letter);
            }
        }
        json.push_back('"');
    }
};

} // namespace scl
