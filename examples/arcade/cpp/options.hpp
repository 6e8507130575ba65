/// The arguments of the black box.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

struct BlackBoxOptions {
    std::filesystem::path folder = "blackbox";
    std::uint64_t size = 4 << 20; // bytes of each of the two files
};

/// The bytes of `512KiB` or `4MiB`, from 4 KiB to 1 GiB; nothing if the text is something else.
std::optional<std::uint64_t> parse_size(const std::string& text);

/// Reads the arguments; prints what is wrong with them and ends the program.
BlackBoxOptions read_options(int count, char** arguments);
