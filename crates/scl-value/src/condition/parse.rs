//! Parses the text of a condition into a tree.

use super::{Node, Operand, Operator};
use crate::path::{FieldPath, read_quoted};
use crate::value::Value;

/// Maximum nesting depth of parentheses and `not`.
const MAX_DEPTH: usize = 50;

/// The byte offset of a mistake in the text, and what is wrong there.
type Wrong = (usize, String);

/// The operators, the longer ones first: `<=` begins with `<`.
const OPERATORS: [(&str, Operator); 8] = [
    ("==", Operator::Equal),
    ("!=", Operator::NotEqual),
    ("<=", Operator::LessOrEqual),
    (">=", Operator::GreaterOrEqual),
    ("<", Operator::Less),
    (">", Operator::Greater),
    ("contains", Operator::Contains),
    ("=", Operator::Equal),
];

pub(super) fn parse(text: &str) -> Result<Node, Wrong> {
    let mut parser = Parser { text, rest: text };
    let node = parser.any_of(0)?;
    parser.skip_space();
    if !parser.rest.is_empty() {
        return Err(parser.wrong("expected `and`, `or` or the end"));
    }
    Ok(node)
}

struct Parser<'t> {
    text: &'t str,
    rest: &'t str,
}

impl<'t> Parser<'t> {
    fn any_of(&mut self, depth: usize) -> Result<Node, Wrong> {
        let mut nodes = vec![self.all_of(depth)?];
        while self.word("or") {
            nodes.push(self.all_of(depth)?);
        }
        Ok(if nodes.len() == 1 { nodes.remove(0) } else { Node::Or(nodes) })
    }

    fn all_of(&mut self, depth: usize) -> Result<Node, Wrong> {
        let mut nodes = vec![self.one(depth)?];
        while self.word("and") {
            nodes.push(self.one(depth)?);
        }
        Ok(if nodes.len() == 1 { nodes.remove(0) } else { Node::And(nodes) })
    }

    fn one(&mut self, depth: usize) -> Result<Node, Wrong> {
        if depth > MAX_DEPTH {
            return Err(self.wrong("it is nested too deep"));
        }
        if self.word("not") {
            return Ok(Node::Not(Box::new(self.one(depth + 1)?)));
        }
        if self.sign("(") {
            let node = self.any_of(depth + 1)?;
            return if self.sign(")") { Ok(node) } else { Err(self.wrong("expected `)`")) };
        }
        let left = self.operand()?;
        match self.operator() {
            Some(operator) => Ok(Node::Compare(left, operator, self.operand()?)),
            None => match left {
                Operand::Field(path) => Ok(Node::True(path)),
                Operand::Constant(_) => Err(self.wrong("expected `==`, `!=`, `<`, `<=`, `>`, `>=` or `contains`")),
            },
        }
    }

    fn operand(&mut self) -> Result<Operand, Wrong> {
        self.skip_space();
        let first = self.rest.chars().next().ok_or_else(|| self.wrong("expected a field or a value"))?;
        let start = self.rest;
        if matches!(first, '"' | '\'') {
            let (text, rest) = read_quoted(start).map_err(|reason| self.wrong(&reason))?;
            self.rest = rest;
            return Ok(Operand::Constant(text.into()));
        }
        if first.is_ascii_digit() || matches!(first, '-' | '+') {
            return self.number();
        }
        for (word, value) in [("true", Value::Bool(true)), ("false", Value::Bool(false)), ("null", Value::Null)] {
            if self.word(word) {
                return Ok(Operand::Constant(value));
            }
        }
        let (path, rest) = match start.strip_prefix('.') {
            // A single `.` is the message itself.
            Some(rest) if !rest.starts_with(|c: char| c.is_alphanumeric() || c == '"') => (FieldPath::default(), rest),
            _ => FieldPath::read(start).map_err(|reason| self.wrong(&reason))?,
        };
        self.rest = rest;
        Ok(Operand::Field(path))
    }

    fn number(&mut self) -> Result<Operand, Wrong> {
        let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+' | '_');
        let end = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        let (text, rest) = self.rest.split_at(end);
        let integer = text.parse().map(Value::Int).or_else(|_| text.parse::<u64>().map(Value::from));
        let value = integer.ok().or_else(|| text.parse().ok().map(Value::Float));
        let value = value.ok_or_else(|| self.wrong(&format!("`{text}` is not a number")))?;
        self.rest = rest;
        Ok(Operand::Constant(value))
    }

    fn operator(&mut self) -> Option<Operator> {
        self.skip_space();
        let (_, operator) = OPERATORS.iter().find(|(sign, _)| {
            if sign.starts_with(|c: char| c.is_alphabetic()) { self.word(sign) } else { self.sign(sign) }
        })?;
        Some(*operator)
    }

    fn sign(&mut self, sign: &str) -> bool {
        self.skip_space();
        let after = self.rest.strip_prefix(sign);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    /// Consumes `word` if it comes next as a whole word: `order` does not begin with `or`.
    fn word(&mut self, word: &str) -> bool {
        self.skip_space();
        let continues =
            |rest: &str| rest.starts_with(|c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '['));
        let after = self.rest.strip_prefix(word).filter(|rest| !continues(rest));
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn skip_space(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn wrong(&self, reason: &str) -> Wrong {
        (self.text.len() - self.rest.len(), reason.to_owned())
    }
}
