// Keeps the newest statistics of the resource map at hand, see the header.
#include "statistics_reader.hpp"

#include <cstdio>

using namespace std::chrono_literals;

namespace {

constexpr auto period = 500ms;
constexpr double history = 60; // seconds: some visits of a primary user, but not those of yesterday

} // namespace

StatisticsReader::~StatisticsReader() {
    {
        std::lock_guard lock(mutex_);
        ending_ = true;
    }
    ended_.notify_all();
    thread_.join();
}

std::vector<mobility::Statistics> StatisticsReader::newest() const {
    std::lock_guard lock(mutex_);
    return newest_;
}

void StatisticsReader::run() {
    std::string failure;
    while (true) {
        auto failure_before = std::exchange(failure, ask());
        // One line for each change; texts of later failures differ in numbers.
        if (!failure.empty() && failure_before.empty()) {
            std::printf("deciding without the resource map: %s\n", failure.c_str());
        } else if (failure.empty() && !failure_before.empty()) {
            std::printf("the resource map answers again\n");
        }
        std::unique_lock lock(mutex_);
        if (ended_.wait_for(lock, period, [this] { return ending_; })) {
            return;
        }
    }
}

// Returns why there is no answer, or an empty text.
std::string StatisticsReader::ask() {
    ospecorr::Query query;
    query.set_seconds(history);
    std::error_code error;
    auto reply = map_.call(query, error);
    std::vector<mobility::Statistics> statistics;
    if (reply && reply->error().empty()) {
        for (const auto &channel : reply->channels()) {
            statistics.push_back({channel.occupied(), channel.mean_idle()});
        }
    }
    std::lock_guard lock(mutex_);
    newest_ = std::move(statistics);
    return reply ? reply->error() : scl::last_error();
}
