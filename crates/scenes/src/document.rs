//! The text of a scene with the settings laid over it, and the way back from a field to its line.

use core::ops::Range;
use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeFloat, DeTable, DeValue};

use crate::error::{Place, Problem, SceneError, nearest};
use crate::model::{PARAMETERS, SceneFile};
use crate::overlay::insert;
use crate::path::{FieldPath, field_at, start_of};
use crate::words::{plain_words, syntax};

/// Largest scene file that is read, in bytes.
pub const MAX_BYTES: u64 = 16 << 20;

/// Latest version of the format.
pub const VERSION: u32 = 1;

/// A scene as text.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    /// The file, or the name of a built-in scene.
    pub(crate) origin: String,
    text: String,
    overrides: Vec<Override>,
}

/// One `key=value` laid over the file. Its text counts as standing behind the file's own.
#[derive(Clone, Debug)]
struct Override {
    /// As it was given.
    key: String,
    value: String,
    /// Offset of the value's text behind the file's.
    offset: usize,
}

impl Document {
    pub(crate) fn new(origin: &str, text: &str) -> Result<Self, SceneError> {
        let bytes = text.len() as u64;
        if bytes > MAX_BYTES {
            return Err(SceneError::file(
                origin,
                Problem::TooLarge {
                    bytes,
                    limit: MAX_BYTES,
                },
            ));
        }
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim().is_empty() {
            return Err(SceneError::file(origin, Problem::Empty));
        }
        Ok(Self {
            origin: origin.to_owned(),
            text: text.to_owned(),
            overrides: Vec::new(),
        })
    }

    /// Lays `key = value` over the file; later ones win.
    pub(crate) fn lay_over(&mut self, key: &str, value: &str) {
        // One byte further than the end of the file, where errors of the file may lie.
        let offset = self
            .overrides
            .last()
            .map_or(self.text.len(), |last| last.offset + last.value.len())
            + 1;
        self.overrides.push(Override {
            key: key.trim().to_owned(),
            value: value.trim().to_owned(),
            offset,
        });
    }

    /// The data of the scene: every number finite, every field known.
    pub(crate) fn read(&self) -> Result<SceneFile, SceneError> {
        let mut tree = self.tree()?;
        self.check_version(&tree)?;
        if let Some((span, problem)) = clean_table(&mut tree) {
            return Err(self.error_in(&tree, &span, problem));
        }
        let root = Spanned::new(0..0, tree);
        let file = SceneFile::deserialize(toml::de::Deserializer::from(root))
            .map_err(|error| self.translate(&error))?;
        self.check_names(&file)?;
        Ok(file)
    }

    /// Bodies, and what makes many of them, share one set of names.
    fn check_names(&self, file: &SceneFile) -> Result<(), SceneError> {
        let mut seen: BTreeMap<&str, FieldPath> = BTreeMap::new();
        for (table, index, name) in file.names() {
            let field = FieldPath::root(table).index(index).key("name");
            if name.is_empty() || name.contains('/') {
                let problem = format!(
                    "\"{name}\" is no name: it needs a letter, and / is for generated bodies"
                );
                return Err(self.error(&field, Problem::Refused(problem)));
            }
            if let Some(first) = seen.get(name) {
                let problem = Problem::DuplicateName {
                    name: name.to_owned(),
                    first: self.words_for(first),
                };
                return Err(self.error(&field, problem));
            }
            seen.insert(name, field);
        }
        Ok(())
    }

    /// An error about a field, with its place.
    pub(crate) fn error(&self, field: &FieldPath, problem: Problem) -> SceneError {
        let start = self.tree().ok().and_then(|tree| start_of(&tree, field));
        SceneError {
            origin: self.origin.clone(),
            place: start.map_or(Place::File, |start| self.place(start)),
            field: field.to_string(),
            problem: Box::new(problem),
        }
    }

    /// A field and its place as words: `body.name in line 12`.
    pub(crate) fn words_for(&self, field: &FieldPath) -> String {
        match self.error(field, Problem::Empty).place {
            Place::At { line, .. } => format!("{field} in line {line}"),
            Place::Set(text) => format!("{field} by --set {text}"),
            Place::File => field.to_string(),
        }
    }

    fn tree(&self) -> Result<DeTable<'_>, SceneError> {
        let parsed = DeTable::parse(&self.text);
        let mut tree = parsed
            .map_err(|error| {
                let span = error.span().unwrap_or_default();
                let text = self.text.get(span.clone()).unwrap_or_default();
                SceneError {
                    origin: self.origin.clone(),
                    place: self.place(span.start),
                    field: String::new(),
                    problem: Box::new(syntax(error.message(), text)),
                }
            })?
            .into_inner();
        for over in &self.overrides {
            self.insert(&mut tree, over)?;
        }
        Ok(tree)
    }

    fn insert<'a>(&self, tree: &mut DeTable<'a>, over: &'a Override) -> Result<(), SceneError> {
        insert(tree, &over.key, &over.value, over.offset).map_err(|(field, problem)| SceneError {
            origin: self.origin.clone(),
            place: Place::Set(format!("{}={}", over.key, over.value)),
            field,
            problem: Box::new(problem),
        })
    }

    fn check_version(&self, tree: &DeTable<'_>) -> Result<(), SceneError> {
        let field = FieldPath::root("version");
        let Some(value) = tree.get("version") else {
            return Err(self.error(
                &field,
                Problem::MissingField("write `version = 1`".to_owned()),
            ));
        };
        let DeValue::Integer(version) = value.get_ref() else {
            return Err(self.error(&field, Problem::Type("expected a whole number".to_owned())));
        };
        let known = i128::from(VERSION);
        match i128::from_str_radix(version.as_str(), version.radix()) {
            Ok(found) if (1..=known).contains(&found) => Ok(()),
            Ok(found) if found > known => Err(self.error(
                &field,
                Problem::Version {
                    found,
                    known: VERSION,
                },
            )),
            _ => Err(self.error(
                &field,
                Problem::Refused(format!("there is no version {}", version.as_str())),
            )),
        }
    }

    /// From serde's words to ours.
    fn translate(&self, error: &toml::de::Error) -> SceneError {
        let span = error.span().unwrap_or(0..0);
        let tree = match self.tree() {
            Ok(tree) => tree,
            Err(error) => return error,
        };
        let message = error.message();
        let mut names = message.split('`').skip(1).step_by(2).map(str::to_owned);
        if message.starts_with("unknown field") || message.starts_with("unknown variant") {
            let name = names.next().unwrap_or_default();
            let mut expected: Vec<String> = names.collect();
            let mut error = self.error_in(&tree, &span, Problem::Empty);
            let in_shape = ["shape", "shapes"].iter().any(|shape| {
                let table = error.field.rsplit_once('.').map_or("", |(table, _)| table);
                table.ends_with(shape) || table.contains(&format!(".{shape}["))
            });
            let what = match message.starts_with("unknown field") {
                true if in_shape && !error.field.contains("population") => "shape",
                true => "field",
                false => "name",
            };
            if matches!(error.place, Place::Set(_)) && !error.field.contains('.') {
                // A bare key may mean a parameter.
                expected.extend(PARAMETERS.iter().map(|&name| name.to_owned()));
            }
            let close = nearest(&name, expected.iter().map(String::as_str)).map(str::to_owned);
            *error.problem = Problem::Unknown {
                what,
                nearest: close,
                expected,
            };
            return error;
        }
        if message.starts_with("missing field") {
            let name = names.next().unwrap_or_default();
            let problem = Problem::MissingField("this field must be given".to_owned());
            let mut error = self.error_in(&tree, &span, problem);
            let table = field_at(&tree, &span).unwrap_or_default();
            error.field = table.key(&name).to_string();
            return error;
        }
        self.error_in(&tree, &span, Problem::Type(plain_words(message)))
    }

    fn error_in(&self, tree: &DeTable<'_>, span: &Range<usize>, problem: Problem) -> SceneError {
        let field = if span.is_empty() {
            None
        } else {
            field_at(tree, span)
        };
        SceneError {
            origin: self.origin.clone(),
            place: if span.is_empty() && span.start <= self.text.len() {
                Place::File
            } else {
                self.place(span.start)
            },
            field: field.unwrap_or_default().to_string(),
            problem: Box::new(problem),
        }
    }

    fn place(&self, offset: usize) -> Place {
        let over = self
            .overrides
            .iter()
            .rev()
            .find(|over| over.offset <= offset);
        if let Some(over) = over {
            return Place::Set(format!("{}={}", over.key, over.value));
        }
        let mut end = offset.min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.text[..end];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place::At {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }
}

/// Turns −0 into 0; answers with the first value that no field takes: a number that is not finite, or a date.
fn clean_table(table: &mut DeTable<'_>) -> Option<(Range<usize>, Problem)> {
    table.iter_mut().find_map(|(_, value)| clean(value))
}

fn clean(value: &mut Spanned<DeValue<'_>>) -> Option<(Range<usize>, Problem)> {
    let span = value.span();
    match value.get_mut() {
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() => {
                if number.abs() == 0.0 {
                    *float = DeFloat::default();
                }
                None
            }
            _ => Some((span, Problem::NotFinite(float.as_str().to_owned()))),
        },
        // The parser hands it on as a table of its own.
        DeValue::Datetime(date) => Some((
            span,
            Problem::Type(format!(
                "found the date or time {date}, which no field takes: a string needs quotes"
            )),
        )),
        DeValue::Array(items) => items.iter_mut().find_map(clean),
        DeValue::Table(table) => clean_table(table),
        _ => None,
    }
}
