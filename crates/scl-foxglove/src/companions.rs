//! Topics in the schemas that panels for maps and 3D know, made of the messages of gates.

use crate::channels::{Channel, Messages, Sent};
use crate::template::Template;
use foxglove::{Context, Encode, Schema, messages};
use scl_record::format::Topic;
use scl_terminal::{Problem, escape, print_err};
use scl_value::{MessageType, Value, read_yaml};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

macro_rules! schemas {
    ($($name:ident),* $(,)?) => {
        /// The schemas that topics can have, without `foxglove.`.
        const SCHEMAS: &[&str] = &[$(stringify!($name)),*];

        fn schema(name: &str) -> Option<Schema> {
            match name.strip_prefix("foxglove.")? {
                $(stringify!($name) => messages::$name::get_schema(),)*
                _ => None,
            }
        }
    };
}
schemas!(
    CameraCalibration,
    CompressedImage,
    CompressedVideo,
    FrameTransform,
    FrameTransforms,
    GeoJson,
    Grid,
    ImageAnnotations,
    JointStates,
    LaserScan,
    LocationFix,
    Log,
    Odometry,
    Point3InFrame,
    PointCloud,
    PoseInFrame,
    PosesInFrame,
    RawImage,
    SceneUpdate,
    VoxelGrid,
);

/// The keys of a topic.
const KEYS: [&str; 3] = ["from", "schema", "message"];

/// Topics as a file describes them.
#[derive(Default)]
pub(crate) struct Descriptions(Vec<Description>);

#[derive(Clone)]
struct Description {
    topic: String,
    from: Topic,
    schema: Schema,
    messages: MessageType,
    template: Template,
}

/// A topic that is made of the messages of another.
pub(crate) struct Companion {
    channel: Channel,
    source: MessageType,
    description: Description,
    /// Whether it was told why a message could not be made.
    is_told: Cell<bool>,
}

impl Descriptions {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, or does not describe topics.
    pub(crate) fn read(file: &Path) -> Result<Self, Problem> {
        let place = file.display().to_string();
        let text = std::fs::read_to_string(file).map_err(|error| Problem::new(error.to_string()).at(&place))?;
        let read = read_yaml(&text).map_err(|error| Problem::from(error).at(&place))?;
        let Value::Map(topics) = read else {
            return Err(Problem::new("expected topics, each with `from`, `schema` and `message`").at(place));
        };
        let topics = topics.iter().map(|(name, value)| {
            let name = scl_value::key_text(name);
            Description::of(&name, value).map_err(|problem| problem.at(format!("{place}, topic `{}`", escape(&name))))
        });
        let topics = topics.collect::<Result<Vec<_>, _>>()?;
        let is_again = |index: usize| topics[..index].iter().any(|known| known.topic == topics[index].topic);
        if let Some(again) = (0..topics.len()).find(|&index| is_again(index)) {
            return Err(Problem::new(format!("topic `{}` is there twice", topics[again].topic)).at(place));
        }
        Ok(Self(topics))
    }

    /// The topics that are made of another, or why one cannot be: messages do not have the fields.
    pub(crate) fn companions(
        &self,
        context: &Arc<Context>,
        from: &Topic,
        messages: &Messages<'_>,
    ) -> impl Iterator<Item = Result<Companion, Problem>> {
        let of_topic = self.0.iter().filter(move |description| description.from == *from);
        of_topic.map(move |description| {
            let place = format!("topic `{}`, made of {from}", description.topic);
            Companion::open(context, description, messages).map_err(|problem| problem.at(place))
        })
    }

    /// The described topics that are made of none of these, in words; `None` if there are none.
    pub(crate) fn missing<'t>(&self, topics: impl Iterator<Item = &'t Topic> + Clone) -> Option<String> {
        let missing = self.0.iter().filter(|description| !topics.clone().any(|topic| *topic == description.from));
        let missing: Vec<_> = missing.map(|it| format!("`{}`, which is made of {}", it.topic, it.from)).collect();
        (!missing.is_empty()).then(|| missing.join(", "))
    }
}

impl Description {
    fn of(topic: &str, value: &Value) -> Result<Self, Problem> {
        if !topic.starts_with('/') {
            return Err(Problem::new("the name of a topic begins with `/`"));
        }
        let Value::Map(entries) = value else { return Err(Problem::new("expected `from`, `schema` and `message`")) };
        let names: Vec<String> = entries.iter().map(|(key, _)| scl_value::key_text(key)).collect();
        if let Some(unknown) = names.iter().find(|name| !KEYS.contains(&name.as_str())) {
            return Err(Problem::new(format!("there is no key `{}`", escape(unknown))).did_you_mean(unknown, KEYS));
        }
        let get = |key: &str| value.get(key).ok_or_else(|| Problem::new(format!("`{key}` is missing")));
        let text = |key: &str| match get(key)?.meaning() {
            Value::Text(text) => Ok(text.clone()),
            _ => Err(Problem::new(format!("`{key}` is not a text"))),
        };
        let from = text("from")?;
        let from = Topic::parse(&from).ok_or_else(|| {
            Problem::new(format!("`{}` is no topic of a gate", escape(&from))).help(
                "name it as recordings do: `/component/gate`, `/component/gate/request` or `/component/gate/reply`",
            )
        })?;
        let name = text("schema")?;
        let schema = schema(&name).ok_or_else(|| {
            let problem = Problem::new(format!("there is no schema `{}`", escape(&name)));
            let known = SCHEMAS.iter().map(|known| format!("foxglove.{known}")).collect::<Vec<_>>();
            problem
                .did_you_mean(&name, known.iter().map(String::as_str))
                .note(format!("the schemas are {}", known.join(", ")))
        })?;
        let messages = MessageType::new(Some(&name), "protobuf", Some(&schema.data));
        let messages = messages.map_err(|error| Problem::new(error.to_string()))?;
        for path in scl_value::FieldPath::leaves(get("message")?) {
            messages.check_field(&path)?;
        }
        let template = Template::of(get("message")?).map_err(Problem::new)?;
        let has_time = "timestamp".parse().is_ok_and(|path| messages.check_field(&path).is_ok());
        let template = if has_time { template.with_time("timestamp") } else { template };
        Ok(Self { topic: topic.to_owned(), from, schema, messages, template })
    }
}

impl Companion {
    fn open(context: &Arc<Context>, description: &Description, messages: &Messages<'_>) -> Result<Self, Problem> {
        let source = MessageType::new(messages.type_name, messages.codec, messages.descriptors);
        let source = source.map_err(|error| Problem::new(error.to_string()))?;
        description.template.check(&source)?;
        let channel = Channel::of_schema(context, &description.topic, description.schema.clone());
        let channel = channel.map_err(|error| Problem::new(error.to_string()))?;
        Ok(Self { channel, source, description: description.clone(), is_told: Cell::new(false) })
    }

    /// Whether a panel shows it.
    pub(crate) fn is_shown(&self) -> bool {
        self.channel.is_shown()
    }

    /// Sends what a message is made into. If it cannot be made, that is told once.
    pub(crate) fn send(&self, sent: &Sent) {
        let Description { topic, from, messages, template, .. } = &self.description;
        let made = template.fill(&self.source.show(&sent.payload), sent.time);
        match made.and_then(|value| messages.encode(&value).map_err(|error| error.to_string())) {
            Ok(payload) => self.channel.send(&Sent { payload, time: sent.time }),
            Err(error) if !self.is_told.replace(true) => {
                print_err(&format!("note: a message of {from} is not sent as `{topic}`: {error}\n"));
            }
            Err(_) => {}
        }
    }

    pub(crate) fn close(&self) {
        self.channel.close();
    }
}
