//! The functions of one gate, by its kind.

use super::content::Content;
use super::enumeration::{names_of_senders, of_senders};
use super::function::Function;
use crate::identifier;
use crate::system::{Gate, System};
use scl_plan::GateKind;

const TIMEOUT: &str = "int64_t timeout_ns";

/// The member of the component's struct that is the gate's handle.
pub(super) fn member(gate: &Gate) -> String {
    identifier::c_family(&gate.snake_name)
}

/// The struct of a request that a `rep` gate has received.
pub(super) fn request_struct(prefix: &str, gate: &Gate) -> Option<String> {
    (gate.plan.kind == GateKind::Rep).then(|| format!("{prefix}_{}_request", gate.snake_name))
}

/// The members of the struct of a request.
pub(super) fn request_members(gate: &Gate) -> String {
    let [request, _] = Content::both(gate);
    let content = match request {
        Content::Struct { name, .. } => format!("{name} *message;"),
        Content::Bytes => "const void *data;\nsize_t size;".to_owned(),
    };
    format!("{content}\nscl_request *handle;")
}

/// All names that a gate declares.
pub(super) fn declared(system: &System, prefix: &str, gate: &Gate) -> Vec<String> {
    let functions = functions(system, prefix, gate).into_iter().map(|function| function.name);
    functions.chain(request_struct(prefix, gate)).collect()
}

/// The functions of a gate; `prefix` is the name of its component's struct.
pub(super) fn functions(system: &System, prefix: &str, gate: &Gate) -> Vec<Function> {
    let maker = Maker { prefix, gate };
    let [first, second] = Content::both(gate);
    match gate.plan.kind {
        GateKind::Pub | GateKind::Push => vec![maker.send(&first)],
        GateKind::Sub | GateKind::Pull => {
            let enumeration = of_senders(system, prefix, gate);
            let from =
                enumeration.map(|enumeration| [maker.recv_from(&first, &enumeration), maker.last_sender(&enumeration)]);
            let calls = [maker.recv(&first), maker.latest(&first)].into_iter().chain(from.into_iter().flatten());
            calls.chain(maker.free(&first)).collect()
        }
        GateKind::Req => [maker.call(&first, &second)].into_iter().chain(maker.free(&second)).collect(),
        GateKind::Rep => vec![maker.take_request(&first), maker.reply(&first, &second), maker.free_request(&first)],
    }
}

struct Maker<'a> {
    prefix: &'a str,
    gate: &'a Gate,
}

impl Maker<'_> {
    fn send(&self, content: &Content) -> Function {
        let [parameters, arguments] = sent(content, "message");
        let call = if content.is_struct() { "send_message" } else { "scl_send" };
        let body = format!("return {call}({}, {arguments}, timeout_ns);", self.handle());
        self.function("send", "", format!("{}, {parameters}, {TIMEOUT}", self.itself()), body)
    }

    fn recv(&self, content: &Content) -> Function {
        let handle = self.handle();
        let body = match content {
            Content::Struct { prefix, .. } => {
                format!("return recv_message({handle}, &{prefix}__descriptor, message, timeout_ns);")
            }
            Content::Bytes => format!("return scl_recv({handle}, timeout_ns, message);"),
        };
        let parameters = format!("{}, {}, {TIMEOUT}", self.itself(), received(content, "message"));
        self.function("recv", "", parameters, body)
    }

    fn latest(&self, content: &Content) -> Function {
        let handle = self.handle();
        let body = match content {
            Content::Struct { prefix, .. } => {
                format!("return latest_message({handle}, &{prefix}__descriptor, message);")
            }
            Content::Bytes => format!("return scl_latest({handle}, message);"),
        };
        let doc = "The newest message, or SCL_NOTHING; older ones are discarded.";
        self.function("latest", doc, format!("{}, {}", self.itself(), received(content, "message")), body)
    }

    fn recv_from(&self, content: &Content, enumeration: &str) -> Function {
        let name = format!("{}_{}", self.prefix, self.gate.snake_name);
        let body = format!(
            "scl_status status = {name}_recv(self, message, timeout_ns);\n\
             if (status == SCL_OK && sender != NULL) {{\n    \
                 status = {name}_last_sender(self, sender);\n\
             }}\n\
             return status;"
        );
        let message = received(content, "message");
        let parameters = format!("{}, {message}, {enumeration} *sender, {TIMEOUT}", self.itself());
        self.function("recv_from", "Also stores who sent the message.", parameters, body)
    }

    fn last_sender(&self, enumeration: &str) -> Function {
        let (member, names) = (member(self.gate), names_of_senders(self.prefix, self.gate));
        let [refuse_self, refuse_sender] = ["self", "sender"].map(refuse_null);
        let body = format!(
            "{refuse_self}\n{refuse_sender}\n\
             const char *last = scl_sender(self->gates.{member});\n\
             if (last == NULL) {{\n    return SCL_NOTHING;\n}}\n\
             size_t count = sizeof {names} / sizeof *{names};\n\
             *sender = ({enumeration})find_name(last, {names}, count);\n\
             return SCL_OK;"
        );
        let doc = "Who sent the message that the last call returned, or SCL_NOTHING before the first one.";
        self.function("last_sender", doc, format!("{}, {enumeration} *sender", self.itself()), body)
    }

    fn call(&self, request: &Content, reply: &Content) -> Function {
        let [sent, arguments] = sent(request, "request");
        let parameters = format!("{}, {sent}, {}, {TIMEOUT}", self.itself(), received(reply, "reply"));
        let call = if request.is_struct() { "call_with_message" } else { "scl_call" };
        let handle = self.handle();
        let body = match reply {
            Content::Bytes => format!("return {call}({handle}, {arguments}, timeout_ns, reply);"),
            Content::Struct { prefix, .. } => format!(
                "scl_gate *gate = {handle};\n\
                 scl_message *bytes = NULL;\n\
                 scl_message **result = reply == NULL ? NULL : &bytes;\n\
                 scl_status status = {call}(gate, {arguments}, timeout_ns, result);\n\
                 return unpack(gate, &{prefix}__descriptor, status, bytes, reply);"
            ),
        };
        self.function("call", "Sends a request and waits for its reply.", parameters, body)
    }

    fn take_request(&self, content: &Content) -> Function {
        let handle = self.handle();
        let take = match content {
            Content::Struct { prefix, .. } => format!(
                "return take_message({handle}, &{prefix}__descriptor, &request->message, &request->handle, timeout_ns);"
            ),
            Content::Bytes => format!(
                "scl_status status = scl_take_request({handle}, timeout_ns, &request->handle);\n\
                 request->data = scl_request_data(request->handle, &request->size);\n\
                 return status;"
            ),
        };
        let body = format!("{}\nmemset(request, 0, sizeof *request);\n{take}", refuse_null("request"));
        let doc = "On success, the request belongs to the caller, who answers it or frees it.";
        let parameters = format!("{}, {}, {TIMEOUT}", self.itself(), self.request_parameter());
        self.function("take_request", doc, parameters, body)
    }

    fn reply(&self, request: &Content, reply: &Content) -> Function {
        let [sent, arguments] = sent(reply, "reply");
        let call = if reply.is_struct() { "reply_with_message" } else { "scl_reply" };
        let body = format!(
            "{}\n\
             scl_status status = {call}(request->handle, {arguments});\n\
             if (status != SCL_ARGUMENT) {{\n{}\n}}\n\
             return status;",
            refuse_null("request"),
            clear_request(request)
        );
        let doc = "Answers and frees the request, which stays as it is only after SCL_ARGUMENT.";
        self.function("reply", doc, format!("{}, {sent}", self.request_parameter()), body)
    }

    fn free_request(&self, request: &Content) -> Function {
        let clear = clear_request(request);
        let body = format!("if (request != NULL) {{\n    scl_request_free(request->handle);\n{clear}\n}}");
        let doc = "Frees a request that is not to be answered.";
        Function { result: "void", ..self.function("free", doc, self.request_parameter(), body) }
    }

    /// The function that frees a received message; `None` for bytes, which are freed with `scl_message_free`.
    fn free(&self, content: &Content) -> Option<Function> {
        let Content::Struct { name, .. } = content else { return None };
        let doc = "Frees a message that was received; NULL is allowed.";
        let function = self.function("free", doc, format!("{name} *message"), free_unpacked("message"));
        Some(Function { result: "void", ..function })
    }

    fn function(&self, call: &str, doc: &'static str, parameters: String, body: String) -> Function {
        Function::new(&format!("{}_{}", self.prefix, self.gate.snake_name), call, doc, parameters, body)
    }

    fn itself(&self) -> String {
        format!("{} *self", self.prefix)
    }

    fn request_parameter(&self) -> String {
        format!("{}_{}_request *request", self.prefix, self.gate.snake_name)
    }

    /// The C expression for the gate's handle: NULL, which the library refuses, if the component is NULL or closed.
    fn handle(&self) -> String {
        format!("self == NULL ? NULL : self->gates.{}", member(self.gate))
    }
}

/// The parameters for what a function sends, and the arguments for the library, or for a helper for messages.
fn sent(content: &Content, name: &str) -> [String; 2] {
    match content {
        Content::Struct { name: message, prefix } => {
            [format!("const {message} *{name}"), format!("(const ProtobufCMessage *){name}, &{prefix}__descriptor")]
        }
        Content::Bytes => ["const void *data, size_t size", "data, size"].map(str::to_owned),
    }
}

/// The parameter in which a function stores what it receives.
fn received(content: &Content, name: &str) -> String {
    match content {
        Content::Struct { name: message, .. } => format!("{message} **{name}"),
        Content::Bytes => format!("scl_message **{name}"),
    }
}

pub(super) fn refuse_null(parameter: &str) -> String {
    format!("if ({parameter} == NULL) {{\n    return scl_fail(SCL_ARGUMENT, \"`{parameter}` is NULL\");\n}}")
}

/// The C statement that frees a struct; NULL is allowed. It works for any message: nested ones have no function of
/// their own for that.
fn free_unpacked(message: &str) -> String {
    format!("protobuf_c_message_free_unpacked((ProtobufCMessage *){message}, NULL);")
}

/// The C statements that free the message of a request's struct and clear the struct, so that nothing leaks or is used
/// again.
fn clear_request(request: &Content) -> String {
    let clear = "    memset(request, 0, sizeof *request);";
    match request {
        Content::Struct { .. } => format!("    {}\n{clear}", free_unpacked("request->message")),
        Content::Bytes => clear.to_owned(),
    }
}
