// Keeps the newest statistics of the resource map at hand.
#pragma once

#include "ospecorr.scl.hpp"
#include "spectrum_mobility.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>

// Asks in a thread of its own: leaving a channel must not wait for a database, and its answers change slowly.
class StatisticsReader {
  public:
    using Gate = scl::Req<ospecorr::Query, ospecorr::Statistics>;

    explicit StatisticsReader(Gate map) : map_(std::move(map)), thread_([this] { run(); }) {}
    ~StatisticsReader();
    StatisticsReader(const StatisticsReader &) = delete;
    StatisticsReader &operator=(const StatisticsReader &) = delete;

    // Those of all channels; empty if the resource map has not answered the last query.
    std::vector<mobility::Statistics> newest() const;

  private:
    void run();
    std::string ask();

    Gate map_;
    mutable std::mutex mutex_;
    std::condition_variable ended_;
    bool ending_ = false;
    std::vector<mobility::Statistics> newest_;
    std::thread thread_; // last: it uses the others
};
