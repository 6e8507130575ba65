/// What the test programs share: commands on standard input, answers on standard output.
#pragma once

#include <scl.hpp>

#include <cstdint>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace support {

/// Answers the test with a line.
template <class... Parts> void say(const Parts&... parts) {
    (std::cout << ... << parts) << std::endl;
}

/// Answers the test with an error, on one line.
inline void say_error(const std::exception& error) {
    std::string text = error.what();
    for (char& letter : text) {
        letter = letter == '\n' ? ' ' : letter;
    }
    say("error: ", text);
}

/// Answers with what a call returns, or with its error.
template <class Call> void answer(Call&& call) {
    try {
        say(call());
    } catch (const scl::Error& error) {
        say_error(error);
    }
}

/// A command of the test, as words.
class Command {
  public:
    /// Reads the next command; false when the test has closed the input.
    bool read() {
        std::string line;
        if (!std::getline(std::cin, line)) {
            return false;
        }
        words_.clear();
        std::istringstream stream(line);
        for (std::string word; stream >> word;) {
            words_.push_back(word);
        }
        return true;
    }

    bool is(const char* name) const { return !words_.empty() && words_[0] == name; }
    std::uint64_t number(std::size_t index) const { return index < words_.size() ? std::stoull(words_[index]) : 0; }

  private:
    std::vector<std::string> words_;
};

/// Values in order of arrival, with consecutive ones merged: `0..10 12..13`.
inline std::string ranges(const std::vector<std::uint64_t>& values) {
    std::string text;
    for (std::size_t at = 0; at < values.size();) {
        std::size_t end = at + 1;
        while (end < values.size() && values[end] == values[end - 1] + 1) {
            ++end;
        }
        text += (text.empty() ? "" : " ") + std::to_string(values[at]) + ".." + std::to_string(values[end - 1] + 1);
        at = end;
    }
    return text;
}

} // namespace support
