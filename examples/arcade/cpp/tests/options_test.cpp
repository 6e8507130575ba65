// The sizes that `--size` takes.
#include "check.hpp"
#include "options.hpp"

int main() {
    CHECK(parse_size("4MiB") == 4u << 20);
    CHECK(parse_size("512KiB") == 512u << 10);
    CHECK(parse_size("1024MiB") == 1u << 30);
    for (const char* wrong : {"", "4", "4MB", "MiB", "-4MiB", "+4MiB", " 4MiB", "4MiBs", "4 MiB", "1KiB", "1025MiB", "nan",
                              "99999999999999999999MiB", "4GiB"}) {
        CHECK(!parse_size(wrong));
    }
}
