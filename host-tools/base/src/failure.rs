//! What a command can end with instead of success, and how it is printed.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::fmt;
use std::ops::Range;
use std::process::ExitCode;

/// What a command can end with instead of success.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The work was done and a check failed: exit code 1.
    Failed(Message),
    /// Bad input or a missing prerequisite: exit code 2.
    Refused(Message),
}

/// A sentence for the user, with what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What is wrong.
    pub sentence: String,
    /// What to do.
    pub help: Option<String>,
    /// Where it is.
    pub place: Option<TextPlace>,
}

/// A piece of a text file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextPlace {
    /// The file's name, as the user gave it.
    pub file: String,
    /// The whole text of the file.
    pub text: String,
    /// The bytes of the text that are meant.
    pub span: Range<usize>,
}

impl Failure {
    /// A check failed.
    #[must_use]
    pub fn failed(sentence: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Failed(Message::new(sentence, Some(help.into())))
    }

    /// The input or a prerequisite is at fault.
    #[must_use]
    pub fn refused(sentence: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Refused(Message::new(sentence, Some(help.into())))
    }

    /// A text file is at fault, at a place in it.
    #[must_use]
    pub fn refused_at(
        sentence: impl Into<String>,
        help: impl Into<String>,
        place: TextPlace,
    ) -> Self {
        let message = Message::new(sentence, Some(help.into()));
        Self::Refused(Message {
            place: Some(place),
            ..message
        })
    }

    /// An error whose own sentence already says what to do.
    #[must_use]
    pub fn from_error(error: impl std::error::Error) -> Self {
        Self::Refused(Message::new(error.to_string(), None))
    }

    /// The process's exit code: 1 or 2.
    #[must_use]
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Failed(_) => 1,
            Self::Refused(_) => 2,
        })
    }

    /// The text for the user, coloured or plain.
    #[must_use]
    pub fn render(&self, coloured: bool) -> String {
        let (Self::Failed(message) | Self::Refused(message)) = self;
        let renderer = if coloured {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let mut text = renderer.render(&[message.error_group()]).to_string();
        if let Some(help) = &message.help {
            let group = Group::with_title(Level::HELP.primary_title(help.as_str()));
            text.push('\n');
            text.push_str(&renderer.render(&[group]).to_string());
        }
        text
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Failed(message) | Self::Refused(message)) = self;
        f.write_str(&message.sentence)
    }
}

impl std::error::Error for Failure {}

impl Message {
    fn new(sentence: impl Into<String>, help: Option<String>) -> Self {
        Self {
            sentence: sentence.into(),
            help,
            place: None,
        }
    }

    /// Line and column where its place begins, from 1; none without a place.
    #[must_use]
    pub fn position(&self) -> Option<[usize; 2]> {
        let place = self.place.as_ref()?;
        let before = place.text.get(..place.span.start)?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        Some([line, before.get(line_start..)?.chars().count() + 1])
    }

    fn error_group(&self) -> Group<'_> {
        let title = Level::ERROR.primary_title(self.sentence.as_str());
        match &self.place {
            None => Group::with_title(title),
            Some(place) => title.element(
                Snippet::source(place.text.as_str())
                    .path(place.file.as_str())
                    .annotation(AnnotationKind::Primary.span(place.span.clone())),
            ),
        }
    }
}
