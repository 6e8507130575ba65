/// Warnings of this library, on standard error like those of the C library.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace scl::detail {

/// Writes a warning, unless `SCL_LOG` is `off` or `error`.
inline void log_warning(const std::string& text) noexcept {
    const char* variable = std::getenv("SCL_LOG");
    std::string_view level = variable == nullptr ? "" : variable;
    if (level != "off" && level != "error") {
        std::fprintf(stderr, " WARN %s\n", text.c_str());
    }
}

} // namespace scl::detail
