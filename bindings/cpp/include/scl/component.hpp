/// Components: opening, waiting for peers, closing.
#pragma once

#include <scl.h>
#include <scl/coding.hpp>
#include <scl/enumeration.hpp>
#include <scl/error.hpp>
#include <scl/log.hpp>
#include <scl/open_components.hpp>
#include <scl/options.hpp>
#include <scl/test_end.hpp>
#include <scl/time.hpp>
#include <scl/uncaught.hpp>

#include <chrono>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace scl {

/// An open component, the base of the components that `scl generate --for cpp` writes.
///
/// Destroying it waits up to a second until running peers have taken everything; the log says what is left then.
class Component {
  public:
    /// Opens a component from a plan, the text that `scl plan` prints: registers it in the runtime folder and opens its
    /// gates. Peers connect by themselves, in whatever order the programs start. If `name` is that of a kind, it is the
    /// component of the kind that `SCL_COMPONENT` names.
    ///
    /// Throws `Taken` if the component is already running, and `Error` if the runtime folder or the plan cannot be
    /// used.
    Component(std::string_view plan_json, const std::string& name, const Options& options = {}) : Component(name) {
        detail::check_library();
        if (options.signals) {
            detail::UncaughtErrors::handle();
        }
        detail::check(
            scl_open(plan_json.data(), plan_json.size(), name.c_str(), options.to_json().c_str(), &handle_));
        name_ = scl_component_name(handle_);
        detail::OpenComponents::instance().add(handle_);
    }

    /// Takes over one of the two components of a unit test.
    Component(TestEnd&& end, const std::string& name) : Component(name) {
        handle_ = end.release();
        linger_ = 0;
    }

    Component(Component&& other) noexcept
        : handle_(std::exchange(other.handle_, nullptr)), name_(std::move(other.name_)), linger_(other.linger_) {}

    Component& operator=(Component&& other) noexcept {
        if (this != &other) {
            destroy();
            handle_ = std::exchange(other.handle_, nullptr);
            name_ = std::move(other.name_);
            linger_ = other.linger_;
        }
        return *this;
    }

    ~Component() { destroy(); }

    /// The component's name in the topology file.
    const std::string& name() const noexcept { return name_; }

    /// Waits until all required peers are connected. Throws `Timeout` if one is missing after `limit`; its text says
    /// why.
    void ready(TimeLimit limit = TimeLimit::none()) const { detail::check(await_peers(limit)); }

    /// `ready` that reports errors as codes. Returns whether all are connected.
    bool ready(TimeLimit limit, std::error_code& error) const {
        return detail::attempt(error, [&] { return await_peers(limit); });
    }

    /// Waits until every peer that is running has taken all messages, then closes. Throws `NotFlushed` with the peers
    /// that have not taken everything after `limit`. Later calls do nothing.
    void close(TimeLimit limit = std::chrono::seconds(1)) { detail::check(finish(limit.nanoseconds())); }

    /// `close` that reports errors as codes. Returns whether the peers have taken everything.
    bool close(TimeLimit limit, std::error_code& error) {
        return detail::attempt(error, [&] { return finish(limit.nanoseconds()); });
    }

    /// Sets a live parameter, as a text like in the topology file: `10ms`. For unit tests, and for programs that adapt
    /// themselves; `update_parameters` takes it over. Throws `Error` if the component has no such parameter
    /// (`Errc::name`), or it is not live or cannot have this value (`Errc::argument`).
    void set_parameter(const std::string& name, const std::string& value) {
        detail::check(require_open());
        detail::check(scl_set_parameter(handle_, name.c_str(), value.c_str()));
    }

    /// A file descriptor for `poll` and `epoll`, readable while a gate has something to receive or a stop is requested.
    /// It belongs to the component.
    int fd() const {
        detail::check(require_open());
        int descriptor = scl_fd(handle_);
        if (descriptor < 0) {
            detail::raise(Errc::system, scl_error());
        }
        return descriptor;
    }

    /// The component in the C interface, borrowed; NULL once closed or moved.
    scl_component* handle() const noexcept { return handle_; }

  private:
    /// Not open yet. The other constructor may throw after this one, and then the destructor closes what it has opened.
    explicit Component(const std::string& name) : name_(name) {}

    scl_status await_peers(TimeLimit limit) const {
        scl_status status = require_open();
        return status == SCL_OK ? detail::named(scl_ready(handle_, limit.nanoseconds()), "component", name_) : status;
    }

    scl_status require_open() const {
        return handle_ == nullptr ? detail::named(SCL_HANDLE, "component", name_) : SCL_OK;
    }

    scl_status finish(std::int64_t limit) noexcept {
        if (handle_ == nullptr) {
            return SCL_OK;
        }
        detail::OpenComponents::instance().remove(handle_);
        scl_status status = scl_close(std::exchange(handle_, nullptr), limit);
        // An uncaught error in another thread has closed it.
        return status == SCL_HANDLE ? SCL_OK : status;
    }

    void destroy() noexcept {
        // Messages that a unit test leaves unread are neither waited for nor reported.
        if (finish(linger_) != SCL_OK && linger_ > 0) {
            detail::log_warning(scl_error());
        }
    }

    scl_component* handle_ = nullptr;
    std::string name_;
    std::int64_t linger_ = detail::linger;
};

/// Opens a component for a unit test, together with its counterpart. Only `set` of the options has an effect. Generated
/// code calls it.
template <class Tested, class Counterpart>
std::pair<Tested, Counterpart> open_test(
    std::string_view plan_json, const std::string& name, const Options& options = {}) {
    detail::check_library();
    TestEnd component, counterpart;
    detail::check(scl_open_test_with(plan_json.data(), plan_json.size(), name.c_str(), options.to_json().c_str(),
                                     component.result(), counterpart.result()));
    return {Tested(std::move(component)), Counterpart(std::move(counterpart))};
}

} // namespace scl
