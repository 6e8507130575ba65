#include "ring_log.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

namespace {

constexpr std::size_t MEMORY = 1 << 20; // bytes of lines that wait for a disk

/// The number in the first line of a file, `{"file":7}`, and 0 if there is none. Unlike its time, the number of a file is
/// right on computers without a battery-backed clock.
std::uint64_t number_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    unsigned long long number = 0;
    return std::sscanf(line.c_str(), "{\"file\":%llu}", &number) == 1 ? number : 0;
}

} // namespace

void RingLog::append(std::string line) {
    line += '\n';
    bytes_ += line.size();
    lines_.push_back(std::move(line));
    while (bytes_ > MEMORY) {
        bytes_ -= lines_.front().size();
        lines_.pop_front();
        lost_++;
    }
}

std::optional<std::string> RingLog::flush() {
    if (descriptor_ >= 0 && is_deleted()) {
        close();
    }
    bool worked = (descriptor_ >= 0 || open_newest()) && write_lines();
    if (worked == works_) {
        return std::nullopt;
    }
    works_ = worked;
    if (!worked) {
        return "cannot write the log in `" + folder_.string() + "`: " + std::strerror(errno) + "; trying again every second";
    }
    std::string text = "writing the log again; lost lines: " + std::to_string(lost_ - lost_before_);
    lost_before_ = lost_;
    return text;
}

bool RingLog::write_lines() {
    while (!lines_.empty()) {
        const std::string& line = lines_.front();
        if (length_ + line.size() > size_ && !begin(1 - which_, number_ + 1)) {
            return false;
        }
        // A line that fits no file is dropped like one that the memory cannot keep.
        bool fits = length_ + line.size() <= size_;
        if (fits && !write_all(line)) {
            return false;
        }
        (fits ? written_ : lost_)++;
        bytes_ -= line.size();
        lines_.pop_front();
    }
    return true;
}

bool RingLog::open_newest() {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
        errno = error.value();
        return false;
    }
    std::uint64_t numbers[] = {number_of(file(0)), number_of(file(1))};
    which_ = numbers[1] > numbers[0];
    number_ = numbers[which_];
    if (number_ == 0) {
        return begin(0, 1);
    }
    descriptor_ = ::open(file(which_).c_str(), O_RDWR | O_APPEND | O_CLOEXEC);
    struct stat status {};
    char last = 0;
    if (descriptor_ >= 0 && fstat(descriptor_, &status) == 0 && pread(descriptor_, &last, 1, status.st_size - 1) == 1) {
        length_ = static_cast<std::uint64_t>(status.st_size);
        // A program that was killed may have left half a line.
        if (last == '\n' || write_all("\n")) {
            return true;
        }
    }
    close();
    return false;
}

bool RingLog::begin(unsigned which, std::uint64_t number) {
    close();
    descriptor_ = ::open(file(which).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
    which_ = which;
    number_ = number;
    length_ = 0;
    if (descriptor_ >= 0 && write_all("{\"file\":" + std::to_string(number) + "}\n")) {
        return true;
    }
    // The next attempt finds the newest file by itself.
    close();
    return false;
}

bool RingLog::write_all(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
        ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
        if (count > 0) {
            done += static_cast<std::size_t>(count);
        } else if (count == 0 || errno != EINTR) {
            int reason = count == 0 ? ENOSPC : errno;
            // No half lines: a full disk can still make a file shorter.
            if (done > 0 && ftruncate(descriptor_, static_cast<off_t>(length_)) != 0) {
                length_ += done;
            }
            errno = reason;
            return false;
        }
    }
    length_ += text.size();
    return true;
}

void RingLog::close() {
    if (descriptor_ >= 0) {
        int reason = errno; // of the call that failed before
        ::close(descriptor_);
        descriptor_ = -1;
        errno = reason;
    }
}

bool RingLog::is_deleted() const {
    struct stat status;
    return fstat(descriptor_, &status) == 0 && status.st_nlink == 0;
}
