/// What the compiler says about calls that a gate does not have because it is of another kind.
#pragma once

#include <scl/codec.hpp>

namespace scl::detail {

/// The base of all gates. A gate hides those functions that it has itself.
class OtherKinds {
  public:
    template <class... Arguments> void send(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate does not send messages; only `pub` and `push` gates do. The "
                                           "topology file says which kind a gate is");
    }

    template <class... Arguments> void try_send(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate does not send messages; only `pub` and `push` gates do. The "
                                           "topology file says which kind a gate is");
    }

    template <class... Arguments> int recv(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate does not receive; only `sub`, `pull` and `rep` gates do. The "
                                           "topology file says which kind a gate is");
        return 0;
    }

    template <class... Arguments> int try_recv(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate does not receive; only `sub`, `pull` and `rep` gates do. The "
                                           "topology file says which kind a gate is");
        return 0;
    }

    template <class... Arguments> int latest(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate has no newest message; only `sub` and `pull` gates do. The "
                                           "topology file says which kind a gate is");
        return 0;
    }

    template <class... Arguments> int* begin(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate does not receive; only `sub`, `pull` and `rep` gates do. The "
                                           "topology file says which kind a gate is");
        return nullptr;
    }

    template <class... Arguments> int* end(Arguments&&...) { return nullptr; }

    template <class... Arguments> int call(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: this gate does not send requests; only `req` gates do. The topology file "
                                           "says which kind a gate is");
        return 0;
    }

    template <class... Arguments> void reply(Arguments&&...) {
        static_assert(never<Arguments...>, "scl: gates do not reply; a `rep` gate receives requests with `recv`, and each "
                                           "of them has `reply`");
    }
};

} // namespace scl::detail
