//! The helpers of a generated source: what all gates share.

use super::content::Content;
use super::parameters::{self, READ_CHOICE, READ_LIST, READ_VALUES, Source};
use super::recursion::is_any_recursive;
use super::{messages, wait};
use crate::system::System;
use scl_plan::GateKind::{self, Pub, Pull, Push, Rep, Req, Sub};

/// The helpers that this system needs; compilers warn about unused ones.
pub(super) fn needed(system: &System) -> Vec<&'static str> {
    let any = |wanted: &dyn Fn(GateKind, bool, bool) -> bool| {
        system.gates().any(|gate| {
            let [first, second] = Content::both(gate).map(|content| content.is_struct());
            wanted(gate.plan.kind, first, second)
        })
    };
    let sends = any(&|kind, first, _| matches!(kind, Pub | Push) && first);
    let asks = any(&|kind, first, _| kind == Req && first);
    let replies = any(&|kind, _, second| kind == Rep && second);
    let receives = any(&|kind, first, _| matches!(kind, Sub | Pull) && first);
    let is_answered = any(&|kind, _, second| kind == Req && second);
    let is_asked = any(&|kind, first, _| kind == Rep && first);
    let tested = || system.components.iter().filter(|component| component.counterpart.is_some());
    let is_tested = tested().any(|component| component.parameters.is_empty());
    let is_tested_with = tested().any(|component| !component.parameters.is_empty());
    let parameters = || system.components.iter().flat_map(|component| &component.parameters);
    let reads = |source| parameters().any(|parameter| parameters::source(parameter) == source);
    let waits = system.components_and_counterparts().any(|component| !wait::gates(component).is_empty());
    let messages = messages(system);
    let mut names = messages.iter().map(|message| message.dotted.as_str());
    let is_recursive = system.descriptors.as_ref().is_some_and(|files| is_any_recursive(files, &mut names));
    let is_named = system.kinds().next().is_some() || system.gates().any(|gate| gate.senders.is_some());
    let all = [
        (true, OPEN),
        (is_named || reads(Source::Choice), FIND_NAME),
        (is_tested, OPEN_TEST),
        (is_tested_with, OPEN_TEST_WITH),
        (reads(Source::Copy), READ_VALUES),
        (reads(Source::List), READ_LIST),
        (reads(Source::Choice), READ_CHOICE),
        (sends || asks || replies, PACK),
        (sends, SEND),
        (asks, CALL),
        (replies, REPLY),
        (receives || is_answered || is_asked, if is_recursive { UNPACK_LIMITED } else { UNPACK_MESSAGE }),
        (receives || is_answered || is_asked, REPORT),
        (receives || is_answered, UNPACK),
        (receives, RECEIVE),
        (is_asked, TAKE),
        (waits, WAIT),
    ];
    all.into_iter().filter_map(|(is_needed, helper)| is_needed.then_some(helper)).collect()
}

const OPEN: &str = "\
static scl_status check_library(void)
{
    if (scl_abi() != SCL_ABI) {
        return scl_fail(SCL_FAILED, \"the library and the `scl.h` that this program was compiled with have different \"
                                    \"versions; recompile the program\");
    }
    return SCL_OK;
}

static scl_status open_component(const char *name, const char *options_json, scl_component **component)
{
    scl_status status = check_library();
    return status != SCL_OK ? status : scl_open(plan, sizeof plan - 1, name, options_json, component);
}";

const FIND_NAME: &str = "\
/* The index of a name, which is one of these. */
static size_t find_name(const char *name, const char *const *names, size_t count)
{
    size_t index = 0;
    while (index + 1 < count && strcmp(names[index], name) != 0) {
        index++;
    }
    return index;
}";

const OPEN_TEST: &str = "\
static scl_status open_test(const char *name, scl_component **component, scl_component **peer)
{
    scl_status status = check_library();
    return status != SCL_OK ? status : scl_open_test(plan, sizeof plan - 1, name, component, peer);
}";

const OPEN_TEST_WITH: &str = "\
static scl_status open_test_with(const char *name, const char *options_json, scl_component **component,
                                 scl_component **peer)
{
    scl_status status = check_library();
    return status != SCL_OK ? status
                            : scl_open_test_with(plan, sizeof plan - 1, name, options_json, component, peer);
}";

const PACK: &str = "\
/* A message as bytes: in `room` if they fit, else in memory of their own. */
typedef struct packed {
    uint8_t room[512];
    uint8_t *memory;
    const uint8_t *data;
    size_t size;
} packed;

static scl_status pack(const ProtobufCMessage *message, const ProtobufCMessageDescriptor *type, packed *bytes)
{
    uint8_t *data = bytes->room;
    bytes->memory = NULL;
    if (message == NULL || message->descriptor != type) {
        char text[256];
        const char *format = message == NULL ? \"the `%s` to send is NULL\"
                                             : \"the `%s` to send is not initialized; assign its __INIT macro first\";
        snprintf(text, sizeof text, format, type->c_name);
        return scl_fail(SCL_ARGUMENT, text);
    }
    bytes->size = protobuf_c_message_get_packed_size(message);
    if (bytes->size > sizeof bytes->room) {
        data = bytes->memory = (uint8_t *)malloc(bytes->size);
        if (data == NULL) {
            return scl_fail(SCL_SYSTEM, \"out of memory\");
        }
    }
    protobuf_c_message_pack(message, data);
    bytes->data = data;
    return SCL_OK;
}";

const SEND: &str = "\
static scl_status send_message(scl_gate *gate, const ProtobufCMessage *message,
                               const ProtobufCMessageDescriptor *type, int64_t timeout_ns)
{
    packed bytes;
    scl_status status = pack(message, type, &bytes);
    if (status == SCL_OK) {
        status = scl_send(gate, bytes.data, bytes.size, timeout_ns);
        free(bytes.memory);
    }
    return status;
}";

const CALL: &str = "\
static scl_status call_with_message(scl_gate *gate, const ProtobufCMessage *request,
                                    const ProtobufCMessageDescriptor *type, int64_t timeout_ns, scl_message **reply)
{
    packed bytes;
    scl_status status = pack(request, type, &bytes);
    if (reply != NULL) {
        *reply = NULL;
    }
    if (status == SCL_OK) {
        status = scl_call(gate, bytes.data, bytes.size, timeout_ns, reply);
        free(bytes.memory);
    }
    return status;
}";

const REPLY: &str = "\
static scl_status reply_with_message(scl_request *request, const ProtobufCMessage *reply,
                                     const ProtobufCMessageDescriptor *type)
{
    packed bytes;
    scl_status status = pack(reply, type, &bytes);
    if (status == SCL_OK) {
        status = scl_reply(request, bytes.data, bytes.size);
        free(bytes.memory);
    }
    return status;
}";

const UNPACK_MESSAGE: &str = "\
static ProtobufCMessage *unpack_message(const ProtobufCMessageDescriptor *type, const uint8_t *data, size_t size)
{
    return protobuf_c_message_unpack(type, NULL, size, data);
}";

/// Limits the nesting depth: protobuf-c has no limit, so a few kilobytes of nested messages would overflow the stack.
const UNPACK_LIMITED: &str = "\
/* Reads a number of protobuf and moves past it. */
static int read_varint(const uint8_t **data, const uint8_t *end, uint64_t *number)
{
    unsigned shift;
    *number = 0;
    for (shift = 0; shift < 64 && *data < end; shift += 7) {
        uint8_t byte = *(*data)++;
        *number |= (uint64_t)(byte & 0x7f) << shift;
        if (byte < 0x80) {
            return 1;
        }
    }
    return 0;
}

/* Whether the bytes are a message whose messages are nested at most 100 deep, as other implementations accept it. */
static int is_shallow(const ProtobufCMessageDescriptor *type, const uint8_t *data, size_t size, unsigned depth)
{
    const uint8_t *end = data + size;
    while (data < end) {
        uint64_t key, length = 0;
        if (!read_varint(&data, end, &key)) {
            return 0;
        }
        switch (key & 7) {
        case 0:
            if (!read_varint(&data, end, &length)) {
                return 0;
            }
            length = 0;
            break;
        case 1:
            length = 8;
            break;
        case 2:
            if (!read_varint(&data, end, &length)) {
                return 0;
            }
            break;
        case 5:
            length = 4;
            break;
        default:
            return 0;
        }
        if (length > (size_t)(end - data)) {
            return 0;
        }
        if ((key & 7) == 2) {
            const ProtobufCFieldDescriptor *field =
                protobuf_c_message_descriptor_get_field(type, (unsigned)(key >> 3));
            if (field != NULL && field->type == PROTOBUF_C_TYPE_MESSAGE) {
                const ProtobufCMessageDescriptor *inner = (const ProtobufCMessageDescriptor *)field->descriptor;
                if (depth == 100 || !is_shallow(inner, data, (size_t)length, depth + 1)) {
                    return 0;
                }
            }
        }
        data += length;
    }
    return 1;
}

/* protobuf-c has no limit for nested messages, and would run out of stack. */
static ProtobufCMessage *unpack_message(const ProtobufCMessageDescriptor *type, const uint8_t *data, size_t size)
{
    return is_shallow(type, data, size, 1) ? protobuf_c_message_unpack(type, NULL, size, data) : NULL;
}";

const REPORT: &str = "\
/* Reports what is not a message of `type`. SCL_OK: the next one is to be received. */
static scl_status report_undecodable(scl_gate *gate, scl_request *request, const ProtobufCMessageDescriptor *type)
{
    char reason[256];
    snprintf(reason, sizeof reason, \"it is not a `%s`\", type->name);
    return scl_undecodable(gate, request, reason);
}";

const UNPACK: &str = "\
/* Frees `bytes`, and stores the message that they are in `*result`: a pointer to the struct of `type`. It is NULL, and
 * the status SCL_OK, for one that is to be skipped. */
static scl_status unpack(scl_gate *gate, const ProtobufCMessageDescriptor *type, scl_status status, scl_message *bytes,
                         void *result)
{
    ProtobufCMessage *message = NULL;
    if (status == SCL_OK) {
        size_t size = 0;
        const uint8_t *data = (const uint8_t *)scl_message_data(bytes, &size);
        message = unpack_message(type, data, size);
        scl_message_free(bytes);
        if (message == NULL) {
            status = report_undecodable(gate, NULL, type);
        }
    }
    if (result != NULL) {
        memcpy(result, &message, sizeof message);
    }
    return status;
}";

const RECEIVE: &str = "\
static scl_status recv_message(scl_gate *gate, const ProtobufCMessageDescriptor *type, void *message,
                               int64_t timeout_ns)
{
    ProtobufCMessage *unpacked = NULL;
    scl_status status;
    do {
        scl_message *bytes = NULL;
        status = scl_recv(gate, timeout_ns, message == NULL ? NULL : &bytes);
        status = unpack(gate, type, status, bytes, &unpacked);
        timeout_ns = SCL_REST;
    } while (status == SCL_OK && unpacked == NULL);
    if (message != NULL) {
        memcpy(message, &unpacked, sizeof unpacked);
    }
    return status;
}

static scl_status latest_message(scl_gate *gate, const ProtobufCMessageDescriptor *type, void *message)
{
    scl_message *bytes = NULL;
    ProtobufCMessage *unpacked = NULL;
    scl_status status = scl_latest(gate, message == NULL ? NULL : &bytes);
    status = unpack(gate, type, status, bytes, &unpacked);
    if (message != NULL) {
        memcpy(message, &unpacked, sizeof unpacked);
    }
    return status == SCL_OK && unpacked == NULL ? SCL_NOTHING : status;
}";

const TAKE: &str = "\
static scl_status take_message(scl_gate *gate, const ProtobufCMessageDescriptor *type, void *message,
                               scl_request **request, int64_t timeout_ns)
{
    ProtobufCMessage *unpacked = NULL;
    scl_status status;
    do {
        status = scl_take_request(gate, timeout_ns, request);
        if (status == SCL_OK) {
            size_t size = 0;
            const uint8_t *data = (const uint8_t *)scl_request_data(*request, &size);
            unpacked = unpack_message(type, data, size);
            if (unpacked == NULL) {
                status = report_undecodable(gate, *request, type);
                *request = NULL;
            }
        }
        timeout_ns = SCL_REST;
    } while (status == SCL_OK && unpacked == NULL);
    memcpy(message, &unpacked, sizeof unpacked);
    return status;
}";

const WAIT: &str = "\
/* Waits at those of the gates `all` whose bits are in `wanted`. */
static scl_status wait_for(scl_component *component, scl_gate *const *all, size_t count, uint64_t wanted,
                           int64_t timeout_ns, uint64_t *ready)
{
    scl_gate *chosen[64];
    uint64_t bits[64];
    size_t index, chosen_count = 0;
    uint64_t found = 0;
    scl_status status;
    for (index = 0; index < count; index++) {
        uint64_t bit = UINT64_C(1) << index;
        if (wanted & bit) {
            bits[chosen_count] = bit;
            chosen[chosen_count++] = all[index];
        }
    }
    status = scl_wait(component, chosen, chosen_count, timeout_ns, &found);
    if (ready != NULL) {
        *ready = 0;
        for (index = 0; index < chosen_count; index++) {
            *ready |= found >> index & 1 ? bits[index] : 0;
        }
    }
    return status;
}";
