/// Converts `json.Everything` between protobuf and JSON with the codecs of this library: the commands of
/// `tests/python/canonical_json.py`, `json HEX` and `proto HEX`.

#include "json.pb.h"
#include "support.hpp"

#include <scl/json.hpp>
#include <scl/protobuf.hpp>

using json::Everything;
using support::say;

static std::string from_hex(const std::string& digits) {
    std::string bytes;
    for (std::size_t at = 0; at + 1 < digits.size(); at += 2) {
        bytes.push_back(static_cast<char>(std::stoi(digits.substr(at, 2), nullptr, 16)));
    }
    return bytes;
}

static std::string to_hex(scl::BytesView bytes) {
    std::string digits;
    const auto* data = static_cast<const unsigned char*>(bytes.data());
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        digits.push_back("0123456789abcdef"[data[at] >> 4]);
        digits.push_back("0123456789abcdef"[data[at] & 15]);
    }
    return digits;
}

template <class From, class To> static void convert(const std::string& bytes) {
    std::string buffer;
    auto message = scl::Codec<Everything, From>::decode(scl::Bytes::borrowed(bytes.data(), bytes.size()));
    say("ok ", to_hex(scl::Codec<Everything, To>::encode(message, buffer)));
}

int main() {
    for (std::string line; std::getline(std::cin, line);) {
        std::string word = line.substr(0, line.find(' '));
        std::string bytes = from_hex(line.substr(word.size() + 1));
        try {
            word == "json" ? convert<scl::Json, scl::Native>(bytes) : convert<scl::Native, scl::Json>(bytes);
        } catch (const scl::Error& error) {
            support::say_error(error);
        }
    }
}
