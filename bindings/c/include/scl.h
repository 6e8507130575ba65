/*
 * SCL for C: typed components and gates over ZeroMQ, wired by one checked topology file. See docs/c.md.
 *
 * Written by cbindgen from the sources of the library; do not edit.
 *
 * - Calls return `SCL_OK` or a negative status; `scl_error` has the text of this thread's last error.
 * - Timeouts are in nanoseconds: 0 does not wait, a negative one waits without limit.
 * - Texts are UTF-8 and end with NUL.
 * - Use each gate from one thread at a time; different gates may be used from different threads.
 */

#ifndef SCL_H
#define SCL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * For generated code: the pointer that is the last argument, if it points to a `type` or is a `void *`; otherwise the program
 * does not compile, whatever the options of the compiler. The second one takes pointers to constants, too.
 */
#if !defined(__cplusplus) && defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define SCL_POINTER(type, ...) _Generic((__VA_ARGS__), type *: (__VA_ARGS__), void *: (__VA_ARGS__))
#define SCL_CONST_POINTER(type, ...) \
    _Generic((__VA_ARGS__), \
        type *: (__VA_ARGS__), const type *: (__VA_ARGS__), void *: (__VA_ARGS__), const void *: (__VA_ARGS__))
#endif


/**
 * Version of this interface. It grows when a change could break a program that was compiled before.
 */
#define SCL_ABI 1

/**
 * As a timeout of scl_recv and scl_take_request: what is left of the timeout of the previous call. For code that goes
 * on after scl_undecodable.
 */
#define SCL_REST -9223372036854775807

/**
 * A component, opened by this process.
 */
typedef struct scl_component scl_component;

/**
 * A gate. It belongs to its component and lives as long.
 */
typedef struct scl_gate scl_gate;

/**
 * A received message. It belongs to the caller, who frees it with scl_message_free.
 */
typedef struct scl_message scl_message;

/**
 * A request. It belongs to the caller, who answers it with scl_reply or frees it with scl_request_free.
 */
typedef struct scl_request scl_request;

/**
 * What a call returns: `SCL_OK`, or a negative number that says why it did not do what it was asked to do.
 */
typedef int32_t scl_status;

/**
 * Done.
 */
#define SCL_OK 0

/**
 * No message has arrived yet. Only calls with a timeout of 0 and `scl_latest` return it.
 */
#define SCL_NOTHING -1

/**
 * The queue of a peer with `when_full: wait` is full. Only `scl_send` with a timeout of 0 returns it; nothing was
 * sent.
 */
#define SCL_FULL -2

/**
 * The time limit is over.
 */
#define SCL_TIMEOUT -3

/**
 * The program was asked to stop by SIGTERM or SIGINT. Return from `main`; this is not a failure.
 */
#define SCL_STOPPED -4

/**
 * The peer disconnected after the request was sent; whether it acted on the request is unknown.
 */
#define SCL_PEER_LOST -5

/**
 * The peer that made a request no longer waits for the reply.
 */
#define SCL_REQUESTER_GONE -6

/**
 * Another thread is using this gate. Use each gate from one thread at a time.
 */
#define SCL_BUSY -7

/**
 * The message is longer than the peer accepts (`max_size` in the topology file). It was not sent.
 */
#define SCL_TOO_LONG -8

/**
 * The buffer is too small. Nothing is lost: the size needed was stored, and the next call returns the same message.
 */
#define SCL_BUFFER -9

/**
 * The bytes received are not a message.
 */
#define SCL_DECODE -10

/**
 * Not all peers have taken all messages. The component was closed nevertheless.
 */
#define SCL_NOT_FLUSHED -11

/**
 * The replier could not decode the request, so it did not act on it.
 */
#define SCL_REFUSED -12

/**
 * The bytes to send are not a message: a text in them is not UTF-8. They were not sent.
 */
#define SCL_ENCODE -13

/**
 * A wrong argument: a NULL pointer, a text that is not UTF-8, a length that no object can have, a wrong option.
 */
#define SCL_ARGUMENT -20

/**
 * The handle was closed or freed, or never was one.
 */
#define SCL_HANDLE -21

/**
 * The system has no component, or the component no gate or parameter, with this name.
 */
#define SCL_NAME -22

/**
 * The gate is of another kind: for example, `scl_send` with a gate that receives. Or the parameter is of another type.
 */
#define SCL_KIND -23

/**
 * The plan is not valid, or was written for another version of SCL.
 */
#define SCL_PLAN -24

/**
 * Another process, or this one, is already running the component.
 */
#define SCL_TAKEN -25

/**
 * The runtime folder cannot be used.
 */
#define SCL_FOLDER -26

/**
 * An environment variable has a value that is not understood, or a parameter has no value or a wrong one.
 */
#define SCL_ENVIRONMENT -27

/**
 * The component was closed by another thread during the call.
 */
#define SCL_CLOSED -28

/**
 * The handle belongs to the parent process. Open a component in one process only.
 */
#define SCL_FORKED -29

/**
 * The operating system refused something.
 */
#define SCL_SYSTEM -30

/**
 * A bug in SCL. The text says where; please report it.
 */
#define SCL_PANIC -31

/**
 * Any other failure.
 */
#define SCL_FAILED -32

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Returns the version of the interface of the loaded library, to be compared with `SCL_ABI`.
 */
uint32_t scl_abi(void);

/**
 * Returns the name of a status: `"SCL_TIMEOUT"` for `SCL_TIMEOUT`. Never NULL; the text is constant.
 */
const char *scl_status_name(scl_status status);

/**
 * Returns the text of this thread's last error: what went wrong, where, and what to do.
 *
 * The text is empty before the first error, and never NULL. It stays as it is until 16 more calls of this thread have
 * failed or the thread ends; then another text may replace it, but its memory is never freed. Calls that succeed leave
 * it alone.
 */
const char *scl_error(void);

/**
 * Opens a component: registers it in the runtime folder and opens its gates. Peers connect by themselves, in whatever
 * order the programs start.
 *
 * `plan_json`, of `plan_len` bytes, is the plan of the system or of one component, as `scl plan` prints it; generated
 * code contains it. `component` is the name of the component, or that of a kind: then the program is the component of
 * the kind that the environment variable SCL_COMPONENT names, which `scl run` sets. `options_json` is NULL for the
 * defaults, or an object with any of these keys:
 *
 *     {"runtime_dir": "/run/rover", "system": "rover-2", "transport": "ipc", "signals": true,
 *      "set": {"controller.period": "10ms"}}
 *
 * The first three replace the environment variables SCL_RUNTIME_DIR, SCL_SYSTEM and SCL_TRANSPORT. `set` has values of
 * parameters, as texts like in the topology file; they count more than those of SCL_SET. The transport is
 * `ipc`, `tcp` or `shm`, or a list with others for single connections, like `ipc,camera.frames=shm`; `shm` needs a
 * library that was built with the feature `shm`. The first component also starts the log (SCL_LOG) and applies the
 * real-time settings (SCL_SCHED, SCL_CPU) to the calling thread. Unless `signals` is false, SIGTERM and SIGINT no
 * longer end the process but request a stop: see scl_stop_requested.
 *
 * On success, `*opened` is the new component, to be closed with scl_close; otherwise it is NULL.
 *
 * Errors: SCL_PLAN, SCL_NAME (the plan has no such component or kind), SCL_TAKEN, SCL_FOLDER, SCL_ENVIRONMENT (also if
 * SCL_COMPONENT names none of the kind, or a parameter has no value or a wrong one), SCL_SYSTEM, SCL_ARGUMENT.
 */
scl_status scl_open(const char *plan_json,
                    size_t plan_len,
                    const char *component,
                    const char *options_json,
                    scl_component **opened);

/**
 * Opens a component for a unit test, together with its counterpart, which has the opposite end of each gate under the
 * same name: where the component receives, its counterpart sends. Both are connected within this process, without
 * sockets or files, so any number of tests may run at the same time. Signals and the environment have no effect.
 *
 * The first three arguments are those of scl_open; of a kind, its first component is opened. On success, `*opened` and
 * `*peer` are the new components, each to be closed with scl_close; otherwise they are NULL.
 *
 * Errors: SCL_PLAN, SCL_NAME (the plan has no such component or kind), SCL_ENVIRONMENT (a parameter has no value),
 * SCL_SYSTEM, SCL_ARGUMENT.
 */
scl_status scl_open_test(const char *plan_json,
                         size_t plan_len,
                         const char *component,
                         scl_component **opened,
                         scl_component **peer);

/**
 * scl_open_test with options, of which only `set` has an effect: `{"set": {"controller.period": "10ms"}}`. They may be
 * NULL.
 *
 * Errors: also SCL_ENVIRONMENT if a parameter has a wrong value.
 */
scl_status scl_open_test_with(const char *plan_json,
                              size_t plan_len,
                              const char *component,
                              const char *options_json,
                              scl_component **opened,
                              scl_component **peer);

/**
 * Waits until all required peers are connected. A timeout of 0 only looks, a negative one waits without limit.
 *
 * Errors: SCL_TIMEOUT (the text names the missing peers and says why), SCL_STOPPED, SCL_CLOSED, SCL_HANDLE.
 */
scl_status scl_ready(scl_component *component,
                     int64_t timeout_ns);

/**
 * Waits until every peer that is running has taken all messages, then closes the component and all its gates, whose
 * handles become invalid. A timeout of 0 hands over what is possible at once, a negative one waits without limit.
 * After a stop request it waits for connected peers only, and at most 500 ms.
 *
 * The component is always closed and freed, whatever the result, except for SCL_HANDLE, SCL_ARGUMENT and SCL_FORKED.
 * Calls that wait in other threads end with SCL_CLOSED. Messages that were received stay valid.
 *
 * Errors: SCL_NOT_FLUSHED (the text says how many messages which peers have not taken).
 */
scl_status scl_close(scl_component *component,
                     int64_t timeout_ns);

/**
 * Returns the name of the component in the topology file, or NULL for a handle that is not valid. For a kind, it says
 * which component of the kind was opened.
 *
 * The text belongs to the component and is valid until scl_close.
 */
const char *scl_component_name(scl_component *component);

/**
 * Returns a gate of the component, or NULL if it has none with this name; scl_error then names the nearest one.
 *
 * The gate belongs to the component and is valid until scl_close. The same name gives the same gate.
 */
scl_gate *scl_gate_by_name(scl_component *component,
                           const char *name);

/**
 * Stores how many values a parameter has: 1, or the items of a list.
 *
 * Parameters have the values that they had when the component was opened: those of the option `set`, else those of the
 * environment variable SCL_SET, else their defaults. scl_update_parameters takes over changes of live ones.
 *
 * Errors: SCL_NAME (the component has no such parameter), SCL_HANDLE, SCL_ARGUMENT.
 */
scl_status scl_parameter_count(scl_component *component,
                               const char *name,
                               size_t *count);

/**
 * Stores the value of a parameter of the type `bool`, or of an item of a list of them. `index` is 0 unless it is a
 * list.
 *
 * Errors: SCL_NAME (the component has no such parameter), SCL_KIND (it has another type), SCL_ARGUMENT (also if the
 * list has no such item), SCL_HANDLE.
 */
scl_status scl_parameter_bool(scl_component *component,
                              const char *name,
                              size_t index,
                              bool *value);

/**
 * scl_parameter_bool for whole numbers of any type: `i8` to `i64`, and `u8` to `u64`.
 *
 * Errors: also SCL_KIND if the value does not fit.
 */
scl_status scl_parameter_i64(scl_component *component,
                             const char *name,
                             size_t index,
                             int64_t *value);

/**
 * scl_parameter_bool for whole numbers that are not negative, of any type: `i8` to `i64`, and `u8` to `u64`.
 *
 * Errors: also SCL_KIND if the value is negative.
 */
scl_status scl_parameter_u64(scl_component *component,
                             const char *name,
                             size_t index,
                             uint64_t *value);

/**
 * scl_parameter_bool for the types `f32` and `f64`.
 */
scl_status scl_parameter_f64(scl_component *component,
                             const char *name,
                             size_t index,
                             double *value);

/**
 * scl_parameter_bool for the type `duration`, in nanoseconds; at most UINT64_MAX, which are 584 years.
 */
scl_status scl_parameter_duration_ns(scl_component *component,
                                     const char *name,
                                     size_t index,
                                     uint64_t *value);

/**
 * scl_parameter_bool for the type `text` and for parameters that are one of several words. The text belongs to the
 * component and is valid until scl_close; of a live parameter, until scl_update_parameters stores true.
 */
scl_status scl_parameter_text(scl_component *component,
                              const char *name,
                              size_t index,
                              const char **value);

/**
 * Stores the address of all values of a parameter in `*items`, and their number in `*count`. `item_type` is the type
 * of the parameter or of its items, as in the topology file: `i8` to `u64` are the numbers of `stdint.h`, `f32` is a
 * `float`, `f64` a `double`, `bool` a `bool`, `text` a `const char *`, `duration` nanoseconds in a `uint64_t`. A word
 * of a choice is a `text`. For generated code.
 *
 * The values belong to the component and are valid until scl_close; of a live parameter, until scl_update_parameters
 * stores true.
 *
 * Errors: SCL_NAME (the component has no such parameter), SCL_KIND (it has another type), SCL_HANDLE, SCL_ARGUMENT.
 */
scl_status scl_parameter_items(scl_component *component,
                               const char *name,
                               const char *item_type,
                               const void **items,
                               size_t *count);

/**
 * Takes over the new values of live parameters: from then on, the calls above store them. Stores whether any has
 * changed since the component was opened or since the last such call. A timeout of 0 only looks, which costs next to
 * nothing, so a loop may do it each time; otherwise it waits until one changes, with a negative timeout without limit.
 *
 * Errors: SCL_STOPPED (while it waits), SCL_CLOSED, SCL_HANDLE, SCL_ARGUMENT.
 */
scl_status scl_update_parameters(scl_component *component,
                                 int64_t timeout_ns,
                                 bool *changed);

/**
 * Sets a live parameter of this component, as a text like in the topology file: `10ms`. scl_update_parameters takes it
 * over, as it does values that `scl set` has set. For unit tests, and for programs that adapt themselves.
 *
 * Errors: SCL_NAME (the component has no such parameter), SCL_ARGUMENT (it is not live, or it cannot have this value),
 * SCL_CLOSED, SCL_HANDLE.
 */
scl_status scl_set_parameter(scl_component *component,
                             const char *name,
                             const char *value);

/**
 * Returns true if all required peers are connected or, for `rep` and `pull` gates, at least one peer. False for an
 * invalid handle and for a gate that another thread is using; `scl_error` then says so.
 */
bool scl_is_connected(const scl_gate *gate);

/**
 * Returns the age, in nanoseconds, of the message that a `sub` gate received last, if its publisher has
 * `latched: true` and had sent it before this gate was connected to it. -1 for every other message, before the first
 * one, for gates of other kinds, and for an invalid handle or a gate that another thread is using; `scl_error` then
 * says so.
 */
int64_t scl_latched_age(const scl_gate *gate);

/**
 * Returns the gate that sent the message that a `sub` gate received last, as `component.gate`: its connection tells.
 * NULL before the first message, for gates of other kinds, and for an invalid handle or a gate that another thread is
 * using; `scl_error` then says so.
 *
 * The text is valid until scl_close.
 */
const char *scl_sender(const scl_gate *gate);

/**
 * Gives memory of `len` bytes, in which to make a message for `scl_send` or `scl_call` of this gate. It belongs to the
 * gate and is valid until the next call to that gate; its content is arbitrary. Using it is optional, it spares
 * allocating.
 *
 * Errors: SCL_TOO_LONG (no peer accepts a message of this length), SCL_BUSY, SCL_HANDLE, SCL_ARGUMENT.
 */
scl_status scl_buffer(scl_gate *gate,
                      size_t len,
                      void **buffer);

/**
 * Sends a message of `len` bytes over a `pub` or `push` gate. The bytes are copied.
 *
 * Only a gate with `backpressure: true` waits, for a peer with `when_full: wait` whose queue is full. A timeout of 0
 * does not wait, a negative one waits without limit.
 *
 * Errors: SCL_FULL (timeout 0), SCL_TIMEOUT, SCL_TOO_LONG, SCL_ENCODE, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY,
 * SCL_HANDLE. After any of them the message was sent to no peer.
 */
scl_status scl_send(scl_gate *gate,
                    const void *data,
                    size_t len,
                    int64_t timeout_ns);

/**
 * Receives the next message of a `sub` or `pull` gate. A timeout of 0 does not wait, a negative one waits without
 * limit.
 *
 * On success, `*message` is the message, to be freed with scl_message_free; otherwise it is NULL.
 *
 * Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT (the text says which peers are missing), SCL_KIND, SCL_STOPPED,
 * SCL_CLOSED, SCL_BUSY, SCL_HANDLE.
 */
scl_status scl_recv(scl_gate *gate,
                    int64_t timeout_ns,
                    scl_message **message);

/**
 * Receives the next message of a `sub` or `pull` gate into a buffer of `capacity` bytes, and stores its length in
 * `*len`. The variant of scl_recv without anything to free.
 *
 * Errors: SCL_BUFFER if the buffer is too small: `*len` is the size needed, and the next call returns the same
 * message, unless scl_latest finds a newer one. `buffer` may be NULL if `capacity` is 0. Otherwise those of scl_recv,
 * and `*len` is 0.
 */
scl_status scl_recv_into(scl_gate *gate,
                         void *buffer,
                         size_t capacity,
                         size_t *len,
                         int64_t timeout_ns);

/**
 * Returns the newest message that has arrived at a `sub` or `pull` gate and discards the older ones. It does not wait.
 *
 * On success, `*message` is the message, to be freed with scl_message_free; otherwise it is NULL.
 *
 * Errors: SCL_NOTHING, and those of scl_recv.
 */
scl_status scl_latest(scl_gate *gate,
                      scl_message **message);

/**
 * Stores in `*missed` how many messages a `sub` or `pull` gate has missed since the last call, because its `deadline`
 * passed without one. It does not wait. Each is told once, those of all senders together.
 *
 * Errors: SCL_FAILED if the gate declares no `deadline`, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY, SCL_HANDLE,
 * SCL_ARGUMENT. `*missed` is 0 then.
 */
scl_status scl_take_missed(scl_gate *gate,
                           uint64_t *missed);

/**
 * Returns the bytes of a message, and stores their number in `*len` unless `len` is NULL. The bytes are those that
 * were received, without a copy; they are valid until scl_message_free. An empty message gives a pointer that is not
 * NULL.
 *
 * A NULL message gives NULL and the length 0, and is no error. A message that was freed must not be used, which cannot
 * be detected.
 */
const void *scl_message_data(const scl_message *message,
                             size_t *len);

/**
 * Frees a message. NULL is allowed.
 */
void scl_message_free(scl_message *message);

/**
 * Sends a request of `len` bytes, which are copied, over a `req` gate and waits for the reply. A negative timeout
 * means the gate's own, from the topology file. A replier that is not connected yet is waited for within that time.
 *
 * On success, `*reply` is the reply, to be freed with scl_message_free; otherwise it is NULL.
 *
 * Calls of one gate follow each other, also with `in_flight`: SCL_BUSY says that another thread is calling. For
 * several calls at once, declare several gates.
 *
 * Errors: SCL_TIMEOUT, SCL_PEER_LOST, SCL_REFUSED, SCL_TOO_LONG, SCL_ENCODE, SCL_KIND, SCL_STOPPED, SCL_CLOSED,
 * SCL_BUSY, SCL_HANDLE. A reply that comes too late is discarded; the next call never receives it.
 */
scl_status scl_call(scl_gate *gate,
                    const void *data,
                    size_t len,
                    int64_t timeout_ns,
                    scl_message **reply);

/**
 * Receives the next request of a `rep` gate. A timeout of 0 does not wait, a negative one waits without limit.
 *
 * On success, `*request` is the request, to be answered with scl_reply or freed with scl_request_free; otherwise it is
 * NULL. Requests may be answered later, in any order, and from any thread.
 *
 * Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY, SCL_HANDLE.
 */
scl_status scl_take_request(scl_gate *gate,
                            int64_t timeout_ns,
                            scl_request **request);

/**
 * Returns the bytes of a request, and stores their number in `*len` unless `len` is NULL. They are valid until
 * scl_reply or scl_request_free.
 *
 * A NULL request gives NULL and the length 0, and is no error. A request that was answered or freed must not be used,
 * which cannot be detected.
 */
const void *scl_request_data(const scl_request *request,
                             size_t *len);

/**
 * Answers a request with `len` bytes, which are copied. It never waits. The request is freed, whatever the result,
 * except for SCL_ARGUMENT and SCL_HANDLE.
 *
 * Errors: SCL_REQUESTER_GONE (it disconnected, which a replier may well ignore), SCL_TOO_LONG, SCL_ENCODE.
 */
scl_status scl_reply(scl_request *request,
                     const void *data,
                     size_t len);

/**
 * Gives memory of `len` bytes, in which to make a reply for `scl_reply`. It belongs to the request and is valid as
 * long; its content is arbitrary. Using it is optional, it spares freeing.
 *
 * Errors: SCL_HANDLE, SCL_ARGUMENT, SCL_SYSTEM (no memory).
 */
scl_status scl_reply_buffer(scl_request *request,
                            size_t len,
                            void **buffer);

/**
 * Frees a request that is not to be answered; its sender waits until its timeout. NULL is allowed.
 */
void scl_request_free(scl_request *request);

/**
 * Waits until at least one of `count` gates of a component has a message or a request, and sets the bits of those that
 * have in `*ready`: bit 0 for `gates[0]`. It takes nothing; scl_recv or scl_take_request of these gates then do not
 * wait. A timeout of 0 only looks, a negative one waits without limit.
 *
 * At most 64 gates, of the kinds `sub`, `pull` and `rep`. No other thread may use any of them during the call.
 *
 * Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY (also if a gate is given
 * twice), SCL_HANDLE. `*ready` is 0 then.
 */
scl_status scl_wait(scl_component *component,
                    scl_gate *const *gates,
                    size_t count,
                    int64_t timeout_ns,
                    uint64_t *ready);

/**
 * Returns a file descriptor for `poll`, `epoll` and event loops, or -1; `scl_error` then says why.
 *
 * It is readable while any gate of the component has a message or a request, until all were taken with a timeout of 0,
 * and from a stop request on. It is level-triggered. It belongs to the component: do not read from it, write to it or
 * close it. Further calls return the same descriptor. From the first call on, a thread of the library does the
 * component's input and output, so that nothing is missed while no call is under way.
 */
int scl_fd(scl_component *component);

/**
 * Writes a gate's counts since its component was opened into a buffer of `capacity` bytes, as a JSON object that ends
 * with NUL, and stores its length without the NUL in `*len`:
 *
 *     {"sent": 2, "received": 0, "replaced": 0, "dropped_oldest": 0, "dropped_newest": 0, "dropped_for_observers": 0,
 *      "lost": 0, "rejected": 0, "undecodable": 0, "missed": 0, "expired": 0, "bytes": 12, "waiting": 0,
 *      "peers": 1, "idle_ns": 1500000,
 *      "connections": [{"peer": "controller.sensor", "connected": true, "published": 2, "taken": 2, "replaced": 0,
 *      "dropped_oldest": 0, "dropped_newest": 0, "lost": 0, "waiting": 0}]}
 *
 * `idle_ns` is the time since a message last moved, or null. `connections` is empty for gates other than `pub` and
 * `push`.
 *
 * Errors: SCL_BUFFER if the buffer is too small: it must be larger than `*len`, and the counts may have grown until
 * the next call. SCL_BUSY, SCL_HANDLE, SCL_ARGUMENT.
 */
scl_status scl_stats(scl_gate *gate,
                     char *buffer,
                     size_t capacity,
                     size_t *len);

/**
 * Keeps `text` as this thread's last error and returns `status`. For generated code.
 */
scl_status scl_fail(scl_status status,
                    const char *text);

/**
 * Reports that the message or reply that this gate received last cannot be decoded, or this request, which is freed
 * whatever the result: its sender is told, so its call fails. `request` is NULL unless the gate is `rep`. `reason`
 * follows "cannot decode this message: ". It is counted. For generated code and for codecs of your own.
 *
 * Returns SCL_OK if the gate skips such messages: receive the next one, with the timeout SCL_REST. They are logged
 * once for each peer.
 *
 * Errors: SCL_DECODE for a gate with `undecodable: fail` and for replies; the text names the gate and its peers.
 * SCL_KIND, SCL_HANDLE.
 */
scl_status scl_undecodable(scl_gate *gate,
                           scl_request *request,
                           const char *reason);

/**
 * Returns true if the program was asked to stop, by SIGTERM or SIGINT.
 *
 * A stop request ends all calls that wait, and makes later ones fail, with SCL_STOPPED, so that a program that returns
 * from `main` after any error stops by itself. If it still runs after the time given by SCL_STOP_WITHIN (default 3s),
 * or when a second signal arrives, half a second after the first or later, it is ended with exit code 128 + the number
 * of the signal.
 */
bool scl_stop_requested(void);

/**
 * From now on the program handles stop requests itself: its gates keep working after the request, also those that
 * wait, and `scl_stop_requested` tells. It still has to end within SCL_STOP_WITHIN.
 */
void scl_handle_stop(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SCL_H */
