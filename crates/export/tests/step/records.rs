//! A reader of the records of a file.

use std::collections::BTreeMap;

use glam::DVec3;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Record(usize),
    Number(f64),
    /// A text, an enumeration, `$` or `*`.
    Word(String),
    List(Vec<Value>),
    /// An entity within another record.
    Entity(String, Vec<Value>),
}

impl Value {
    pub(super) fn record(&self) -> Result<usize, String> {
        match self {
            Value::Record(record) => Ok(*record),
            other => Err(format!("{other:?} is no reference")),
        }
    }

    pub(super) fn number(&self) -> Result<f64, String> {
        match self {
            Value::Number(number) => Ok(*number),
            other => Err(format!("{other:?} is no number")),
        }
    }

    pub(super) fn list(&self) -> Result<&[Value], String> {
        match self {
            Value::List(list) => Ok(list),
            other => Err(format!("{other:?} is no list")),
        }
    }

    pub(super) fn is_true(&self) -> bool {
        *self == Value::Word(".T.".to_owned())
    }
}

/// Reads one value from the start of a text; returns what follows.
fn value(text: &str) -> Result<(Value, &str), String> {
    let text = text.trim_start();
    let first = text.chars().next().ok_or("the text ends")?;
    let take = |is_part: fn(char) -> bool| {
        let end = text[1..].find(|c| !is_part(c)).map_or(text.len(), |at| at + 1);
        (&text[..end], &text[end..])
    };
    match first {
        '#' => {
            let (word, rest) = take(|c| c.is_ascii_digit());
            Ok((Value::Record(word[1..].parse().map_err(|_| word.to_owned())?), rest))
        }
        '(' => {
            let mut list = Vec::new();
            let mut rest = &text[1..];
            loop {
                rest = rest.trim_start_matches([',', ' ']);
                if let Some(after) = rest.strip_prefix(')') {
                    return Ok((Value::List(list), after));
                }
                let (item, after) = value(rest)?;
                list.push(item);
                rest = after;
            }
        }
        '\'' => {
            // Apostrophes within a text are doubled.
            let mut end = 1;
            loop {
                end += text[end..].find('\'').ok_or("a text does not end")? + 1;
                if !text[end..].starts_with('\'') {
                    return Ok((Value::Word(text[..end].to_owned()), &text[end..]));
                }
                end += 1;
            }
        }
        '.' => {
            let (word, rest) = take(|c| c.is_ascii_alphanumeric() || c == '.' || c == '_');
            Ok((Value::Word(word.to_owned()), rest))
        }
        '$' | '*' => Ok((Value::Word(first.to_string()), &text[1..])),
        '-' | '0'..='9' => {
            let (word, rest) = take(|c| c.is_ascii_digit() || ".E-+".contains(c));
            if !word.contains('.') {
                return Err(format!("{word} has no decimal point"));
            }
            Ok((Value::Number(word.parse().map_err(|_| word.to_owned())?), rest))
        }
        _ => {
            let (name, rest) = take(|c| c.is_ascii_alphanumeric() || c == '_');
            let (arguments, rest) = value(rest)?;
            Ok((Value::Entity(name.to_owned(), arguments.list()?.to_vec()), rest))
        }
    }
}

/// The records of a file by their numbers.
pub(super) struct Records(pub(super) BTreeMap<usize, Value>);

impl Records {
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let data = text.split("DATA;\n").nth(1).ok_or("no data")?;
        let data = data.split("ENDSEC;").next().ok_or("no end")?;
        let mut records = BTreeMap::new();
        for line in data.lines() {
            let (number, body) = line.split_once('=').ok_or_else(|| line.to_owned())?;
            let number = number[1..].parse().map_err(|_| line.to_owned())?;
            // A protocol's year is a whole number.
            let body = body
                .strip_suffix(';')
                .ok_or_else(|| line.to_owned())?
                .replace(",2020,", ",2020.,");
            let body = body.replace("CONTEXT(3)", "CONTEXT(3.)");
            let (found, rest) = value(&body)?;
            if !rest.is_empty() || records.insert(number, found).is_some() {
                return Err(format!("{line}: {rest}"));
            }
        }
        Ok(Self(records))
    }

    pub(super) fn of(&self, record: usize, name: &str) -> Result<&[Value], String> {
        match self.0.get(&record) {
            Some(Value::Entity(found, arguments)) if found == name => Ok(arguments),
            other => Err(format!("#{record} is {other:?}, not {name}")),
        }
    }

    pub(super) fn name(&self, record: usize) -> &str {
        match self.0.get(&record) {
            Some(Value::Entity(name, _)) => name,
            _ => "",
        }
    }

    pub(super) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = (usize, &'a [Value])> {
        self.0.iter().filter_map(move |(number, found)| match found {
            Value::Entity(entity, arguments) if entity == name => Some((*number, &arguments[..])),
            _ => None,
        })
    }

    pub(super) fn vector(&self, record: usize, name: &str) -> Result<DVec3, String> {
        let parts = self.of(record, name)?[1].list()?;
        let [x, y, z] = [0, 1, 2].map(|k| parts[k].number());
        Ok(DVec3::new(x?, y?, z?))
    }

    /// Origin, z axis and x axis of a placement.
    pub(super) fn placement(&self, record: usize) -> Result<[DVec3; 3], String> {
        let parts = self.of(record, "AXIS2_PLACEMENT_3D")?;
        let [z, x] = [2, 3].map(|k| self.vector(parts[k].record()?, "DIRECTION"));
        let (z, x) = (z?, x?);
        if (z.length() - 1.0).abs() > 1e-12 || (x.length() - 1.0).abs() > 1e-12 || z.dot(x).abs() > 1e-12 {
            return Err(format!("#{record} is no frame"));
        }
        Ok([self.vector(parts[1].record()?, "CARTESIAN_POINT")?, z, x])
    }

    pub(super) fn vertex(&self, record: usize) -> Result<DVec3, String> {
        self.vector(self.of(record, "VERTEX_POINT")?[1].record()?, "CARTESIAN_POINT")
    }
}
