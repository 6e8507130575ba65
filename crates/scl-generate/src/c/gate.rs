//! The functions of one gate, by its kind.

use super::content::Content;
use super::function::Function;
use crate::identifier;
use crate::system::Gate;
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

/// The members of that struct.
pub(super) fn request_members(gate: &Gate) -> Vec<String> {
    let [request, _] = Content::both(gate);
    let content = match request {
        Content::Struct { name, .. } => vec![format!("{name} *message;")],
        Content::Bytes => vec!["const void *data;".to_owned(), "size_t size;".to_owned()],
    };
    content.into_iter().chain(["scl_request *handle;".to_owned()]).collect()
}

/// All names that a gate declares.
pub(super) fn declared(prefix: &str, gate: &Gate) -> Vec<String> {
    let functions = functions(prefix, gate).into_iter().map(|function| function.name);
    functions.chain(request_struct(prefix, gate)).collect()
}

/// The functions of a gate; `prefix` is the name of its component's struct.
pub(super) fn functions(prefix: &str, gate: &Gate) -> Vec<Function> {
    let maker = Maker { prefix, gate };
    let [first, second] = Content::both(gate);
    let functions = match gate.plan.kind {
        GateKind::Pub | GateKind::Push => vec![Some(maker.send(&first))],
        GateKind::Sub | GateKind::Pull => {
            vec![Some(maker.recv(&first)), Some(maker.latest(&first)), maker.free(&first)]
        }
        GateKind::Req => vec![Some(maker.call(&first, &second)), maker.free(&second)],
        GateKind::Rep => {
            let reply = maker.reply(&first, &second);
            vec![Some(maker.take_request(&first)), Some(reply), Some(maker.free_request(&first))]
        }
    };
    functions.into_iter().flatten().collect()
}

struct Maker<'a> {
    prefix: &'a str,
    gate: &'a Gate,
}

impl Maker<'_> {
    fn send(&self, content: &Content) -> Function {
        let sent = Sent::of(content, "message");
        let call = if content.is_struct() { "send_message" } else { "scl_send" };
        let body = vec![format!("return {call}({}, {}, timeout_ns);", self.handle(), sent.arguments)];
        let parameters = [vec![self.itself()], sent.parameters, vec![TIMEOUT.to_owned()]].concat();
        self.function("send", "", parameters, body)
    }

    fn recv(&self, content: &Content) -> Function {
        let parameters = vec![self.itself(), received(content, "message"), TIMEOUT.to_owned()];
        let body = match content {
            Content::Struct { prefix, .. } => {
                format!("return recv_message({}, &{prefix}__descriptor, message, timeout_ns);", self.handle())
            }
            Content::Bytes => format!("return scl_recv({}, timeout_ns, message);", self.handle()),
        };
        self.function("recv", "", parameters, vec![body])
    }

    fn latest(&self, content: &Content) -> Function {
        let body = match content {
            Content::Struct { prefix, .. } => {
                format!("return latest_message({}, &{prefix}__descriptor, message);", self.handle())
            }
            Content::Bytes => format!("return scl_latest({}, message);", self.handle()),
        };
        let doc = "The newest message, or SCL_NOTHING; older ones are discarded.";
        self.function("latest", doc, vec![self.itself(), received(content, "message")], vec![body])
    }

    fn call(&self, request: &Content, reply: &Content) -> Function {
        let sent = Sent::of(request, "request");
        let results = vec![received(reply, "reply"), TIMEOUT.to_owned()];
        let parameters = [vec![self.itself()], sent.parameters, results].concat();
        let call = if request.is_struct() { "call_with_message" } else { "scl_call" };
        let (handle, arguments) = (self.handle(), sent.arguments);
        let body = match reply {
            Content::Bytes => vec![format!("return {call}({handle}, {arguments}, timeout_ns, reply);")],
            Content::Struct { prefix, .. } => vec![
                format!("scl_gate *gate = {handle};"),
                "scl_message *bytes = NULL;".to_owned(),
                "scl_message **result = reply == NULL ? NULL : &bytes;".to_owned(),
                format!("scl_status status = {call}(gate, {arguments}, timeout_ns, result);"),
                format!("return unpack(gate, &{prefix}__descriptor, status, bytes, reply);"),
            ],
        };
        self.function("call", "Sends a request and waits for its reply.", parameters, body)
    }

    fn take_request(&self, content: &Content) -> Function {
        let handle = self.handle();
        let mut body = refuse_null("request");
        body.push("memset(request, 0, sizeof *request);".to_owned());
        match content {
            Content::Struct { prefix, .. } => body.push(format!(
                "return take_message({handle}, &{prefix}__descriptor, &request->message, &request->handle, timeout_ns);"
            )),
            Content::Bytes => body.extend([
                format!("scl_status status = scl_take_request({handle}, timeout_ns, &request->handle);"),
                "request->data = scl_request_data(request->handle, &request->size);".to_owned(),
                "return status;".to_owned(),
            ]),
        }
        let doc = "On success, the request belongs to the caller, who answers it or frees it.";
        let parameters = vec![self.itself(), self.request_parameter(), TIMEOUT.to_owned()];
        self.function("take_request", doc, parameters, body)
    }

    fn reply(&self, request: &Content, reply: &Content) -> Function {
        let sent = Sent::of(reply, "reply");
        let call = if reply.is_struct() { "reply_with_message" } else { "scl_reply" };
        let mut body = refuse_null("request");
        body.push(format!("scl_status status = {call}(request->handle, {});", sent.arguments));
        body.push("if (status != SCL_ARGUMENT) {".to_owned());
        body.extend(clear_request(request));
        body.extend(["}", "return status;"].map(str::to_owned));
        let doc = "Answers and frees the request, which stays as it is only after SCL_ARGUMENT.";
        self.function("reply", doc, [vec![self.request_parameter()], sent.parameters].concat(), body)
    }

    fn free_request(&self, request: &Content) -> Function {
        let mut body = vec!["if (request != NULL) {".to_owned(), "    scl_request_free(request->handle);".to_owned()];
        body.extend(clear_request(request));
        body.push("}".to_owned());
        let doc = "Frees a request that is not to be answered.";
        Function { result: "void", ..self.function("free", doc, vec![self.request_parameter()], body) }
    }

    /// Frees a message that was received; bytes are freed with `scl_message_free`.
    fn free(&self, content: &Content) -> Option<Function> {
        let Content::Struct { name, .. } = content else { return None };
        let body = vec![free_unpacked("message")];
        let doc = "Frees a message that was received; NULL is allowed.";
        Some(Function { result: "void", ..self.function("free", doc, vec![format!("{name} *message")], body) })
    }

    fn function(&self, call: &str, doc: &'static str, parameters: Vec<String>, body: Vec<String>) -> Function {
        let name = format!("{}_{}_{call}", self.prefix, self.gate.snake_name);
        Function { doc, result: "scl_status", name, parameters, body }
    }

    fn itself(&self) -> String {
        format!("{} *self", self.prefix)
    }

    fn request_parameter(&self) -> String {
        format!("{}_{}_request *request", self.prefix, self.gate.snake_name)
    }

    /// The gate's handle. It is NULL, which the library refuses, if the component is NULL or closed.
    fn handle(&self) -> String {
        format!("self == NULL ? NULL : self->gates.{}", member(self.gate))
    }
}

/// What a function sends.
struct Sent {
    parameters: Vec<String>,
    /// What the library, or a helper for messages, gets of them.
    arguments: String,
}

impl Sent {
    fn of(content: &Content, name: &str) -> Self {
        match content {
            Content::Struct { name: message, prefix } => Self {
                parameters: vec![format!("const {message} *{name}")],
                arguments: format!("(const ProtobufCMessage *){name}, &{prefix}__descriptor"),
            },
            Content::Bytes => Self {
                parameters: vec!["const void *data".to_owned(), "size_t size".to_owned()],
                arguments: "data, size".to_owned(),
            },
        }
    }
}

/// The parameter in which a function stores what it receives.
fn received(content: &Content, name: &str) -> String {
    match content {
        Content::Struct { name: message, .. } => format!("{message} **{name}"),
        Content::Bytes => format!("scl_message **{name}"),
    }
}

pub(super) fn refuse_null(parameter: &str) -> Vec<String> {
    let refusal = format!("    return scl_fail(SCL_ARGUMENT, \"`{parameter}` is NULL\");");
    vec![format!("if ({parameter} == NULL) {{"), refusal, "}".to_owned()]
}

/// Frees a struct; NULL is allowed. Only messages that are not nested have a function of their own for that.
fn free_unpacked(message: &str) -> String {
    format!("protobuf_c_message_free_unpacked((ProtobufCMessage *){message}, NULL);")
}

/// Frees what a request's struct refers to besides its handle, so that it can neither leak nor be used again.
fn clear_request(request: &Content) -> Vec<String> {
    let message = match request {
        Content::Struct { .. } => Some(format!("    {}", free_unpacked("request->message"))),
        Content::Bytes => None,
    };
    message.into_iter().chain(["    memset(request, 0, sizeof *request);".to_owned()]).collect()
}
