//! The text of a scene with the settings laid over it, and the way back from a field to its line.

use core::ops::Range;
use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeFloat, DeTable, DeValue};

use crate::error::{Place, Problem, SceneError, nearest};
use crate::model::{PARAMETERS, SceneFile};
use crate::path::{FieldPath, Places};

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
        if let Some((span, number)) = clean_numbers_in(&mut tree) {
            return Err(self.error_in(&tree, &span, Problem::NotFinite(number)));
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
        let start = self
            .tree()
            .ok()
            .and_then(|tree| Places::of(&tree).start_of(field));
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
            .map_err(|error| SceneError {
                origin: self.origin.clone(),
                place: self.place(error.span().map_or(0, |span| span.start)),
                field: String::new(),
                problem: Box::new(syntax(error.message())),
            })?
            .into_inner();
        for over in &self.overrides {
            self.insert(&mut tree, over)?;
        }
        Ok(tree)
    }

    fn insert<'a>(&self, tree: &mut DeTable<'a>, over: &'a Override) -> Result<(), SceneError> {
        let wrong = |field: &str, problem: Problem| SceneError {
            origin: self.origin.clone(),
            place: Place::Set(format!("{}={}", over.key, over.value)),
            field: field.to_owned(),
            problem: Box::new(problem),
        };
        // What is no TOML value is a bare word: `settings.pairs=none`.
        let value = DeValue::parse(&over.value).unwrap_or_else(|_| {
            Spanned::new(
                0..over.value.len(),
                DeValue::String(Cow::Borrowed(over.value.as_str())),
            )
        });
        let value = shifted(value, over.offset);
        let path = full_path(&over.key);
        let Some((last, parents)) = path.split_last() else {
            return Err(wrong(
                "",
                Problem::MissingField("a key before the =".to_owned()),
            ));
        };
        let mut place = Slot::Table(tree);
        for (depth, step) in parents.iter().enumerate() {
            place = place
                .enter(step, over.offset)
                .map_err(|problem| wrong(&path[..=depth].join("."), problem))?;
        }
        place
            .put(last, value)
            .map_err(|problem| wrong(&path.join("."), problem))
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
            let table = Places::of(&tree)
                .field_at(&span)
                .cloned()
                .unwrap_or_default();
            error.field = table.key(&name).to_string();
            return error;
        }
        self.error_in(&tree, &span, Problem::Type(plain_words(message)))
    }

    fn error_in(&self, tree: &DeTable<'_>, span: &Range<usize>, problem: Problem) -> SceneError {
        let places = Places::of(tree);
        let field = if span.is_empty() {
            None
        } else {
            places.field_at(span)
        };
        SceneError {
            origin: self.origin.clone(),
            place: if span.is_empty() && span.start <= self.text.len() {
                Place::File
            } else {
                self.place(span.start)
            },
            field: field.map(ToString::to_string).unwrap_or_default(),
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

/// Where a value can be laid into a tree.
enum Slot<'t, 'a> {
    Table(&'t mut DeTable<'a>),
    Item(&'t mut Spanned<DeValue<'a>>),
}

impl<'t, 'a> Slot<'t, 'a> {
    /// One step down: a key of a table (made if it is not there), a number or a name in a list.
    fn enter(self, step: &'a str, offset: usize) -> Result<Self, Problem> {
        let table = match self {
            Self::Table(table) => table,
            Self::Item(item) => match item.get_mut() {
                DeValue::Table(table) => table,
                DeValue::Array(items) => {
                    let index = position_in(items.iter(), step)?;
                    return items
                        .get_mut(index)
                        .map(Self::Item)
                        .ok_or_else(|| Problem::Refused(format!("there is no item {step}")));
                }
                _ => return Err(Problem::Refused("this field holds no table".to_owned())),
            },
        };
        let key = Spanned::new(offset..offset, Cow::Borrowed(step));
        let empty = Spanned::new(offset..offset, DeValue::Table(DeTable::new()));
        if !table.contains_key(step) {
            table.insert(key, empty);
        }
        table
            .get_mut(step)
            .map(Self::Item)
            .ok_or_else(|| Problem::Refused("this field holds no table".to_owned()))
    }

    fn put(self, last: &'a str, value: Spanned<DeValue<'a>>) -> Result<(), Problem> {
        let table = match self {
            Self::Table(table) => table,
            Self::Item(item) => match item.get_mut() {
                DeValue::Table(table) => table,
                DeValue::Array(items) => {
                    let index = position_in(items.iter(), last)?;
                    if let Some(item) = items.get_mut(index) {
                        *item = value;
                    }
                    return Ok(());
                }
                _ => return Err(Problem::Refused("this field holds no table".to_owned())),
            },
        };
        // Taken out first: an entry that stays keeps its old key, with the place in the file.
        table.remove(last);
        table.insert(Spanned::new(value.span(), Cow::Borrowed(last)), value);
        Ok(())
    }
}

/// An item by number from 0, or a table by its `name`.
fn position_in<'v, 'a: 'v>(
    items: impl ExactSizeIterator<Item = &'v Spanned<DeValue<'a>>>,
    step: &str,
) -> Result<usize, Problem> {
    let count = items.len();
    if let Ok(index) = step.parse::<usize>() {
        if index < count {
            return Ok(index);
        }
        return Err(Problem::Refused(format!(
            "there are {count} items, numbered from 0"
        )));
    }
    let mut names = Vec::with_capacity(count);
    for (index, item) in items.enumerate() {
        let name = match item.get_ref() {
            DeValue::Table(table) => table.get("name"),
            _ => None,
        };
        if let Some(DeValue::String(name)) = name.map(Spanned::get_ref) {
            if name == step {
                return Ok(index);
            }
            names.push(name.to_string());
        }
    }
    let close = nearest(step, names.iter().map(String::as_str)).map(str::to_owned);
    Err(Problem::Unknown {
        what: "name",
        nearest: close,
        expected: names,
    })
}

/// `n` means `parameters.n`.
fn full_path(key: &str) -> Vec<&str> {
    if PARAMETERS.contains(&key) {
        return vec!["parameters", key];
    }
    key.split('.').filter(|step| !step.is_empty()).collect()
}

/// The same value with its places moved behind the text of the file.
fn shifted(value: Spanned<DeValue<'_>>, by: usize) -> Spanned<DeValue<'_>> {
    let moved = |span: Range<usize>| span.start + by..span.end + by;
    let span = moved(value.span());
    let inner = match value.into_inner() {
        DeValue::Array(items) => {
            DeValue::Array(items.into_iter().map(|item| shifted(item, by)).collect())
        }
        DeValue::Table(table) => DeValue::Table(
            table
                .into_iter()
                .map(|(key, value)| {
                    let place = moved(key.span());
                    (Spanned::new(place, key.into_inner()), shifted(value, by))
                })
                .collect(),
        ),
        other => other,
    };
    Spanned::new(span, inner)
}

/// Turns −0 into 0; answers with the first number that is not finite.
fn clean_numbers_in(table: &mut DeTable<'_>) -> Option<(Range<usize>, String)> {
    table.iter_mut().find_map(|(_, value)| clean_numbers(value))
}

fn clean_numbers(value: &mut Spanned<DeValue<'_>>) -> Option<(Range<usize>, String)> {
    let span = value.span();
    match value.get_mut() {
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() => {
                if number.abs() == 0.0 {
                    *float = DeFloat::default();
                }
                None
            }
            _ => Some((span, float.as_str().to_owned())),
        },
        DeValue::Array(items) => items.iter_mut().find_map(clean_numbers),
        DeValue::Table(table) => clean_numbers_in(table),
        _ => None,
    }
}

/// The nesting limit is the parser's own, and its words are about itself.
fn syntax(message: &str) -> Problem {
    if message.contains("recurs") {
        Problem::Syntax("nested too deep".to_owned())
    } else {
        Problem::Syntax(message.replace('`', "'"))
    }
}

/// Serde speaks of Rust's types, a scene of numbers, lists and tables.
fn plain_words(message: &str) -> String {
    let mut words = message.replace('`', "");
    for (theirs, ours) in [
        ("invalid type: map", "found a table"),
        ("invalid type: sequence", "found a list"),
        ("invalid type: floating point", "found the number"),
        ("invalid type: ", "found the "),
        ("invalid value: ", "found the "),
        ("invalid length ", "found a list of "),
        ("expected f64", "expected a number"),
        ("expected a sequence", "expected a list"),
        ("expected a boolean", "expected true or false"),
        ("expected struct ", "expected a table for "),
        ("expected u64", "expected a whole number from 0 up"),
        ("expected usize", "expected a whole number from 0 up"),
        (
            "expected u32",
            "expected a whole number from 0 to 4294967295",
        ),
        ("wanted string or table", "expected a string"),
    ] {
        words = words.replace(theirs, ours);
    }
    words
}
