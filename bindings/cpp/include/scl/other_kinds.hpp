/// Compile errors for calls that only gates of other kinds have.
#pragma once

#include <scl/codec.hpp>

namespace scl::detail {

template <class... Arguments> struct SendsNothing {
    static_assert(never<Arguments...>, "scl: this gate does not send messages; only `pub` and `push` gates do. "
                                       "The topology file says which kind a gate is");
    static constexpr int value = 0;
};

template <class... Arguments> struct ReceivesNothing {
    static_assert(never<Arguments...>, "scl: this gate does not receive; only `sub`, `pull` and `rep` gates do. "
                                       "The topology file says which kind a gate is");
    static constexpr int value = 0;
};

template <class... Arguments> struct HasNoNewest {
    static_assert(never<Arguments...>, "scl: this gate has no newest message; only `sub` and `pull` gates do. "
                                       "The topology file says which kind a gate is");
    static constexpr int value = 0;
};

template <class... Arguments> struct MissesNothing {
    static_assert(never<Arguments...>, "scl: this gate misses no messages; only `sub` and `pull` gates have a `deadline`. "
                                       "The topology file says which kind a gate is");
    static constexpr int value = 0;
};

template <class... Arguments> struct CallsNothing {
    static_assert(never<Arguments...>, "scl: this gate does not send requests; only `req` gates do. "
                                       "The topology file says which kind a gate is");
    static constexpr int value = 0;
};

template <class... Arguments> struct RepliesToNothing {
    static_assert(never<Arguments...>, "scl: gates do not reply; a `rep` gate receives requests with `recv`, "
                                       "and each of them has `reply`");
    static constexpr int value = 0;
};

/// The base of all gates. A gate hides the functions that it has itself.
class OtherKinds {
  public:
    template <class... Arguments> int send(Arguments&&...) { return SendsNothing<Arguments...>::value; }
    template <class... Arguments> int try_send(Arguments&&...) { return SendsNothing<Arguments...>::value; }
    template <class... Arguments> int recv(Arguments&&...) { return ReceivesNothing<Arguments...>::value; }
    template <class... Arguments> int try_recv(Arguments&&...) { return ReceivesNothing<Arguments...>::value; }
    template <class... Arguments> const int* begin(Arguments&&...) { return &ReceivesNothing<Arguments...>::value; }
    template <class... Arguments> const int* end(Arguments&&...) { return nullptr; }
    template <class... Arguments> int latest(Arguments&&...) { return HasNoNewest<Arguments...>::value; }
    template <class... Arguments> int take_missed(Arguments&&...) { return MissesNothing<Arguments...>::value; }
    template <class... Arguments> int call(Arguments&&...) { return CallsNothing<Arguments...>::value; }
    template <class... Arguments> int reply(Arguments&&...) { return RepliesToNothing<Arguments...>::value; }
};

} // namespace scl::detail
