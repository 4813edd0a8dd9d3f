//! A tree of XML elements, written with indentation.

use super::format::AnyError;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use super::prepared::text;

/// An XML element.
#[derive(Debug, Clone, Default)]
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    content: Vec<Content>,
}

#[derive(Debug, Clone)]
enum Content {
    Element(Element),
    Text(String),
}

impl Element {
    pub(super) fn new(name: &'static str) -> Self {
        Self {
            name,
            ..Self::default()
        }
    }

    /// Adds an attribute.
    pub(super) fn with(mut self, key: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((key, value.into()));
        self
    }

    /// Adds an attribute that consists of numbers.
    pub(super) fn with_numbers(self, key: &'static str, values: &[f64]) -> Self {
        self.with(key, numbers(values))
    }

    /// Adds a child element.
    pub(super) fn child(mut self, child: Element) -> Self {
        self.push(child);
        self
    }

    /// Adds child elements.
    pub(super) fn children(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.content.extend(children.into_iter().map(Content::Element));
        self
    }

    /// Adds a child element that contains only text.
    pub(super) fn leaf(self, name: &'static str, words: impl Into<String>) -> Self {
        let mut leaf = Element::new(name);
        leaf.content.push(Content::Text(words.into()));
        self.child(leaf)
    }

    pub(super) fn push(&mut self, child: Element) {
        self.content.push(Content::Element(child));
    }

    /// Writes the document with this element as its root and a comment before it.
    pub(super) fn document(&self, preamble: &str) -> Result<Vec<u8>, AnyError> {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        let write = |writer: &mut Writer<Vec<u8>>| -> std::io::Result<()> {
            writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("utf-8"), None)))?;
            writer.write_event(comment(preamble))?;
            self.write(writer)
        };
        write(&mut writer)?;
        let mut bytes = writer.into_inner();
        bytes.push(b'\n');
        Ok(bytes)
    }

    fn write(&self, writer: &mut Writer<Vec<u8>>) -> std::io::Result<()> {
        let mut start = BytesStart::new(self.name);
        for (key, value) in &self.attributes {
            start.push_attribute((*key, value.as_str()));
        }
        if self.content.is_empty() {
            return writer.write_event(Event::Empty(start));
        }
        writer.write_event(Event::Start(start))?;
        for content in &self.content {
            match content {
                Content::Element(element) => element.write(writer)?,
                Content::Text(words) => writer.write_event(Event::Text(BytesText::new(words)))?,
            }
        }
        writer.write_event(Event::End(BytesEnd::new(self.name)))
    }
}

fn comment(words: &str) -> Event<'static> {
    // A comment must not contain two hyphens; minus signs replace them and read the same.
    Event::Comment(BytesText::from_escaped(format!(" {} ", words.replace("--", "−−"))))
}

/// Formats numbers, separated by spaces.
pub(super) fn numbers(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|&value| text(value)).collect();
    texts.join(" ")
}
