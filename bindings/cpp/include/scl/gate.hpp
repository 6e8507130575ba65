/// The base of all gates.
#pragma once

#include <scl.h>
#include <scl/coding.hpp>
#include <scl/component.hpp>
#include <scl/error.hpp>
#include <scl/other_kinds.hpp>
#include <scl/time.hpp>

#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace scl {

/// The part of a gate that does not depend on its messages.
///
/// A gate belongs to its component: once that is closed or destroyed, calls throw `scl::Error` (`Errc::handle`).
/// Different threads may use different gates at the same time; one gate serves one thread at a time (else
/// `Errc::busy`).
class Gate : public detail::OtherKinds {
  public:
    Gate(Gate&& other) noexcept
        : handle_(std::exchange(other.handle_, nullptr)), component_(other.component_), name_(std::move(other.name_)) {}

    Gate& operator=(Gate&& other) noexcept {
        handle_ = std::exchange(other.handle_, nullptr);
        component_ = other.component_;
        name_ = std::move(other.name_);
        return *this;
    }

    /// The full name of the gate, with its component: `sensor.measurements`.
    const std::string& name() const noexcept { return name_; }

    /// Returns true if all required peers are connected; for `pull` and `rep` gates, if at least one peer is.
    bool is_connected() const noexcept { return scl_is_connected(handle_); }

    /// The gate's counts as JSON text, which `scl_stats` in `scl.h` describes.
    std::string stats() const {
        std::string json(1024, '\0');
        std::size_t length = 0;
        scl_status status = SCL_OK;
        while ((status = scl_stats(handle_, json.data(), json.size(), &length)) == SCL_BUFFER) {
            // With some room for counts that grow in the meantime.
            json.resize(2 * length);
        }
        require(told(status));
        json.resize(length);
        return json;
    }

    /// The gate in the C interface, borrowed; NULL after a move.
    scl_gate* handle() const noexcept { return handle_; }

    /// Its component in the C interface, borrowed.
    scl_component* component() const noexcept { return component_; }

  protected:
    Gate(const Component& component, const std::string& name)
        : handle_(scl_gate_by_name(component.handle(), name.c_str())), component_(component.handle()),
          name_(component.name() + "." + name) {
        if (handle_ == nullptr) {
            detail::raise(Errc::name, scl_error());
        }
    }

    ~Gate() = default;

    /// Returns the status of a call to this gate, with a text that names the gate.
    scl_status told(scl_status status) const { return detail::named(status, "gate", name_); }

    /// Throws the exception of a status unless it is `SCL_OK`.
    void require(scl_status status) const {
        if (status == SCL_OK) {
            return;
        }
        if (handle_ == nullptr) {
            detail::raise(Errc::argument, "this gate was moved to another object; use that one");
        }
        detail::raise(static_cast<Errc>(status), scl_error());
    }

  private:
    scl_gate* handle_;
    scl_component* component_;
    std::string name_;
};

} // namespace scl
