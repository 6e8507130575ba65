//! The parameters of a component: a struct with their values, and enums of those that are one of several words.

use super::comment::write_comment;
use super::enumeration::{constant, write_enum, write_names};
use super::gate::refuse_null;
use super::literal::literal;
use super::prefix;
use crate::clash::{Declaration, Origin};
use crate::identifier;
use crate::system::{Component, Parameter, System};
use crate::writer::Writer;
use scl_plan::{ParameterType, Scalar};

/// How a parameter gets its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// Its values are copied into the member.
    Copy,
    /// The member is the index of its word.
    Choice,
    /// The member points to the items of a list of any length, and another one has their number.
    List,
}

/// `rover_controller_parameters`; `None` if the component has none.
pub(super) fn struct_name(prefix: &str, component: &Component) -> Option<String> {
    (!component.parameters.is_empty()).then(|| format!("{prefix}_parameters"))
}

/// `rover_controller_mode`.
fn choice_name(prefix: &str, parameter: &Parameter) -> String {
    format!("{prefix}_{}", parameter.snake_name)
}

/// The array of the words of a choice.
fn words(enumeration: &str) -> String {
    format!("{enumeration}_names")
}

/// The function that fills the struct.
fn reader(prefix: &str) -> String {
    format!("read_{prefix}_parameters")
}

pub(super) fn source(parameter: &Parameter) -> Source {
    match &parameter.plan.kind {
        ParameterType::List(_, None) => Source::List,
        ParameterType::OneOf(_) => Source::Choice,
        ParameterType::One(_) | ParameterType::List(_, Some(_)) => Source::Copy,
    }
}

/// The member of the struct. The name of a duration ends with its unit.
fn member(parameter: &Parameter) -> String {
    match parameter.plan.kind.scalar() {
        Some(Scalar::Duration) => format!("{}_ns", parameter.snake_name),
        _ => identifier::c_family(&parameter.snake_name),
    }
}

/// The member with the number of items of a list of any length.
fn count_member(parameter: &Parameter) -> Option<String> {
    (source(parameter) == Source::List).then(|| format!("{}_count", parameter.snake_name))
}

/// The names of the struct, its members, and the enums.
pub(super) fn declarations(system: &System, component: &Component, scope: &str) -> Vec<Declaration> {
    let own = prefix(system, component);
    let mut found = Vec::new();
    let Some(name) = struct_name(&own, component) else { return found };
    let inside = format!("the C struct `{name}`");
    found.push(Declaration::new(scope, name, Origin::component(component)));
    for parameter in &component.parameters {
        let members = [Some(member(parameter)), count_member(parameter)].into_iter().flatten();
        let origin = Origin::parameter(component, parameter);
        found.extend(members.map(|name| Declaration::new(&inside, name, origin.clone())));
    }
    for (parameter, choice) in component.choices() {
        let enumeration = choice_name(&own, parameter);
        for value in &choice.values {
            let origin = Origin::choice(component, parameter, value);
            found.push(Declaration::new(scope, constant(&enumeration, &value.snake_name), origin));
        }
        let origin = Origin::parameter(component, parameter);
        found.push(Declaration::new(scope, words(&enumeration), origin.clone()));
        found.push(Declaration::new(scope, enumeration, origin));
    }
    found
}

/// Writes the enums and the struct into the header.
pub(super) fn declare(prefix: &str, component: &Component, out: &mut Writer) {
    let Some(name) = struct_name(prefix, component) else { return };
    for (parameter, choice) in component.choices() {
        let comment = format!("The values of the parameter `{}.{}`.", component.name, parameter.name);
        let values = choice.values.iter().map(|it| it.snake_name.as_str());
        write_enum(&comment, &choice_name(prefix, parameter), values, out);
    }
    let end = match component.has_live_parameters() {
        true => "they are updated, or the component is closed",
        false => "the component is closed",
    };
    out.blank();
    write_comment(
        &format!("The parameters of `{}`. Texts and lists are valid until {end}.", component.name),
        None,
        out,
    );
    out.block(format!("typedef struct {name} {{"), &format!("}} {name};"), |out| {
        for parameter in &component.parameters {
            let headline = format!("Parameter ({}): {}", parameter.plan.declared_at, parameter.plan.described());
            write_comment(&headline, parameter.plan.doc.as_deref(), out);
            out.line(format!("{};", declarator(prefix, parameter)));
            count_member(parameter).iter().for_each(|count| out.line(format!("size_t {count};")));
        }
    });
}

fn declarator(prefix: &str, parameter: &Parameter) -> String {
    let name = member(parameter);
    match &parameter.plan.kind {
        ParameterType::One(scalar) => of_type(*scalar, &name),
        ParameterType::OneOf(_) => format!("{} {name}", choice_name(prefix, parameter)),
        ParameterType::List(scalar, Some(length)) => of_type(*scalar, &format!("{name}[{length}]")),
        ParameterType::List(Scalar::Text, None) => format!("const char *const *{name}"),
        ParameterType::List(scalar, None) => format!("const {}", of_type(*scalar, &format!("*{name}"))),
    }
}

fn of_type(scalar: Scalar, name: &str) -> String {
    let type_name = match scalar {
        Scalar::Bool => "bool",
        Scalar::I8 => "int8_t",
        Scalar::I16 => "int16_t",
        Scalar::I32 => "int32_t",
        Scalar::I64 => "int64_t",
        Scalar::U8 => "uint8_t",
        Scalar::U16 => "uint16_t",
        Scalar::U32 => "uint32_t",
        Scalar::U64 | Scalar::Duration => "uint64_t",
        Scalar::F32 => "float",
        Scalar::F64 => "double",
        Scalar::Text => return format!("const char *{name}"),
    };
    format!("{type_name} {name}")
}

/// Writes the words of choices and the function that fills the struct into the source.
pub(super) fn define(system: &System, component: &Component, out: &mut Writer) {
    let own = prefix(system, component);
    if component.parameters.is_empty() {
        return;
    }
    for (parameter, choice) in component.choices() {
        let array = words(&choice_name(&own, parameter));
        write_names(&array, choice.values.iter().map(|it| it.word.as_str()), out);
    }
    let read: Vec<String> = component.parameters.iter().map(|parameter| read(&own, parameter)).collect();
    out.line(format!("\nstatic scl_status {}({own} *self)", reader(&own)));
    out.block("{", "}", |out| {
        out.line("scl_component *component = self->component;");
        out.line(format!("{own}_parameters *values = &self->parameters;\nscl_status status = SCL_OK;"));
        out.line(read.join("\n"));
        out.line("return status;");
    });
}

/// The statement that reads a parameter.
fn read(prefix: &str, parameter: &Parameter) -> String {
    let (name, member) = (literal(&parameter.name), member(parameter));
    let word = parameter.plan.kind.scalar().unwrap_or(Scalar::Text).word();
    match (source(parameter), count_member(parameter)) {
        (Source::Choice, _) => {
            let enumeration = choice_name(prefix, parameter);
            let words = words(&enumeration);
            format!(
                "values->{member} = ({enumeration})read_choice(component, {name}, {words},\n    \
                     sizeof {words} / sizeof *{words}, &status);"
            )
        }
        (Source::List, Some(count)) => {
            let pointer = declared_pointer(parameter);
            format!(
                "values->{member} = ({pointer})read_list(component, {name}, \"{word}\", &values->{count}, &status);"
            )
        }
        _ => {
            format!("read_values(component, {name}, \"{word}\", &values->{member}, sizeof values->{member}, &status);")
        }
    }
}

/// The type of the pointer to the items of a list.
fn declared_pointer(parameter: &Parameter) -> String {
    match parameter.plan.kind.scalar() {
        Some(Scalar::Text) | None => "const char *const *".to_owned(),
        Some(scalar) => format!("const {}", of_type(scalar, "*")),
    }
}

/// Lines that are run once the component was opened, and fill the struct.
pub(super) fn once_open(prefix: &str, component: &Component) -> String {
    match component.parameters.is_empty() {
        true => String::new(),
        false => format!("    status = {}(self);\n", reader(prefix)),
    }
}

/// The body of the function that takes over live parameters.
pub(super) fn update_body(prefix: &str) -> String {
    let (refuse, reader) = (refuse_null("self"), reader(prefix));
    format!(
        "{refuse}\n\
         scl_status status = scl_update_parameters(self->component, timeout_ns, changed);\n\
         return status == SCL_OK && *changed ? {reader}(self) : status;"
    )
}

/// Reads values into a member.
pub(super) const READ_VALUES: &str = "\
static void read_values(scl_component *component, const char *name, const char *type, void *values, size_t size,
                        scl_status *status)
{
    const void *items;
    size_t count;
    if (*status == SCL_OK) {
        *status = scl_parameter_items(component, name, type, &items, &count);
    }
    if (*status == SCL_OK) {
        memcpy(values, items, size);
    }
}";

/// Finds the items of a list.
pub(super) const READ_LIST: &str = "\
static const void *read_list(scl_component *component, const char *name, const char *type, size_t *count,
                             scl_status *status)
{
    const void *items = NULL;
    if (*status == SCL_OK) {
        *status = scl_parameter_items(component, name, type, &items, count);
    }
    return items;
}";

/// Reads the word of a choice.
pub(super) const READ_CHOICE: &str = "\
/* The index of the value of a parameter, which is one of these words. */
static size_t read_choice(scl_component *component, const char *name, const char *const *words, size_t count,
                          scl_status *status)
{
    const char *word;
    if (*status == SCL_OK) {
        *status = scl_parameter_text(component, name, 0, &word);
    }
    return *status == SCL_OK ? find_name(word, words, count) : 0;
}";
