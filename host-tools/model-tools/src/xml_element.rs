//! A tree of XML elements.

use quick_xml::Writer;
use quick_xml::events::{BytesText, Event};
use std::io::{self, Write};

/// An element with its attributes and either children or a text.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Self>,
    content: Option<String>,
}

impl Element {
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            attributes: Vec::new(),
            children: Vec::new(),
            content: None,
        }
    }

    /// With an attribute that is a word.
    pub fn text(mut self, key: &'static str, value: &str) -> Self {
        self.attributes.push((key, value.into()));
        self
    }

    /// With an attribute of numbers, each with all the digits that it needs.
    pub fn numbers(self, key: &'static str, values: &[f64]) -> Self {
        let words: Vec<String> = values.iter().map(f64::to_string).collect();
        self.text(key, &words.join(" "))
    }

    /// With one more child.
    pub fn child(self, child: Self) -> Self {
        self.children([child])
    }

    /// With more children.
    pub fn children(mut self, children: impl IntoIterator<Item = Self>) -> Self {
        self.children.extend(children);
        self
    }

    /// With a text between its tags, in the place of children.
    pub fn content(mut self, content: &str) -> Self {
        self.content = Some(content.into());
        self
    }

    fn write<W: Write>(&self, writer: &mut Writer<W>) -> io::Result<()> {
        let attributes = self.attributes.iter();
        let element = writer
            .create_element(self.name)
            .with_attributes(attributes.map(|(key, value)| (*key, value.as_str())));
        if let Some(content) = &self.content {
            element.write_text_content(BytesText::new(content))?;
        } else if self.children.is_empty() {
            element.write_empty()?;
        } else {
            let children = self.children.iter();
            element.write_inner_content(|writer| {
                children
                    .into_iter()
                    .try_for_each(|child| child.write(writer))
            })?;
        }
        Ok(())
    }
}

/// Writes a document: a comment, then the tree.
pub(crate) fn write(root: &Element, comment: &str, out: impl Write) -> io::Result<()> {
    let mut writer = Writer::new_with_indent(out, b' ', 2);
    writer.write_event(Event::Comment(BytesText::from_escaped(comment)))?;
    root.write(&mut writer)?;
    writer.get_mut().write_all(b"\n")
}
