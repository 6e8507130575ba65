#include "options.hpp"

#include <cstdio>
#include <cstdlib>

static const char USAGE[] = "usage: blackbox [--folder PATH] [--size SIZE]\n"
                            "  --folder PATH   folder of the log: two files in a subfolder named after the system (default: blackbox)\n"
                            "  --size SIZE     size of each file, such as 512KiB (default: 4MiB)\n";

std::optional<std::uint64_t> parse_size(const std::string& text) {
    unsigned long long number = 0;
    char unit = 0;
    int length = 0;
    int found = std::sscanf(text.c_str(), "%10llu%c%niB", &number, &unit, &length);
    if (found != 2 || text[0] < '0' || text[0] > '9' || text.substr(static_cast<std::size_t>(length)) != "iB" ||
        (unit != 'K' && unit != 'M')) {
        return std::nullopt;
    }
    std::uint64_t bytes = number << (unit == 'K' ? 10 : 20);
    return bytes >= 4096 && bytes <= 1 << 30 ? std::optional(bytes) : std::nullopt;
}

/// The name that the system runs under: another vehicle has another one.
static std::string system_name() {
    const char* name = std::getenv("SCL_SYSTEM");
    return name != nullptr && *name != '\0' ? name : "arcade";
}

BlackBoxOptions read_options(int count, char** arguments) {
    BlackBoxOptions options;
    for (int i = 1; i < count; i++) {
        std::string name = arguments[i];
        if (name == "--help") {
            std::fputs(USAGE, stdout);
            std::exit(0);
        }
        if ((name != "--folder" && name != "--size") || i + 1 == count) {
            bool known = name == "--folder" || name == "--size";
            std::fprintf(stderr, known ? "error: `%s` needs a value\n" : "error: unknown argument `%s`\n", name.c_str());
            std::fputs(USAGE, stderr);
            std::exit(2);
        }
        std::string value = arguments[++i];
        if (name == "--folder") {
            options.folder = value;
        } else if (auto size = parse_size(value)) {
            options.size = *size;
        } else {
            std::fprintf(stderr, "error: --size `%s` is not a size from 4KiB to 1024MiB, such as 512KiB\n", value.c_str());
            std::exit(2);
        }
    }
    options.folder /= system_name();
    return options;
}
