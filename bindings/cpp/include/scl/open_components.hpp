/// The open components, so that they can be closed at the end of the program.
#pragma once

#include <scl.h>
#include <scl/log.hpp>

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

namespace scl::detail {

/// Time for peers to take what was sent when a component is destroyed, in nanoseconds. As in Rust programs.
inline constexpr std::int64_t linger = 1'000'000'000;

class OpenComponents {
  public:
    /// Never destroyed, because components may be static objects.
    static OpenComponents& instance() {
        static auto* components = new OpenComponents;
        return *components;
    }

    void add(scl_component* component) {
        std::lock_guard<std::mutex> lock(mutex_);
        components_.push_back(component);
    }

    void remove(scl_component* component) noexcept {
        std::lock_guard<std::mutex> lock(mutex_);
        components_.erase(std::remove(components_.begin(), components_.end(), component), components_.end());
    }

    /// Closes all open components. Calls of other threads to their gates end with an error.
    void close_all() noexcept {
        std::vector<scl_component*> components;
        {
            std::lock_guard<std::mutex> lock(mutex_);
            components.swap(components_);
        }
        for (scl_component* component : components) {
            if (scl_close(component, linger) == SCL_NOT_FLUSHED) {
                log_warning(scl_error());
            }
        }
    }

  private:
    std::mutex mutex_;
    std::vector<scl_component*> components_;
};

} // namespace scl::detail
