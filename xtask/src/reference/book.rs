//! The format of reference cases and of answers.

use std::fs;
use std::path::{Path, PathBuf};

use carom_math::{Vec2, vec2};
use carom_render::read_file;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::exit::{Failure, fail};

/// One file: the cases of a category.
#[derive(Debug, Deserialize)]
pub(super) struct Book {
    /// What is asked for; the file's name where it is not said.
    #[serde(default)]
    pub(super) category: String,
    /// The cases in order.
    pub(super) cases: Vec<Case>,
}

/// One question and its answer.
#[derive(Debug, Deserialize)]
pub(super) struct Case {
    /// Its name, such as `mass-000-ngon3`.
    pub(super) id: String,
    /// Numbers as strings: shortest decimals of doubles.
    pub(super) inputs: Value,
    /// `{"value", "hp", "unit"}` by key.
    pub(super) outputs: Map<String, Value>,
}

/// Outputs by key, as the reference file names them.
pub(super) type Outputs = Map<String, Value>;

/// What the program says to a case.
#[derive(Debug, Serialize)]
pub(super) struct Answer {
    pub(super) id: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) seconds: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) outputs: Option<Outputs>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) error: Option<String>,
}

/// All answers.
#[derive(Debug, Serialize)]
pub(super) struct Results {
    pub(super) engine: &'static str,
    pub(super) cases: Vec<Answer>,
}

/// Reads every `*.json` of a folder, in order of their names.
pub(super) fn read_folder(folder: &Path) -> Result<Vec<Book>, Failure> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => fail!("cannot read the folder {}: {error}", folder.display()),
    };
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "json")
            && path.is_file()
        {
            paths.push(path);
        }
    }
    paths.sort();
    if paths.is_empty() {
        fail!("{} holds no reference file (*.json)", folder.display());
    }
    paths.iter().map(|path| read(path)).collect()
}

/// Largest reference file that is read, in bytes: over a hundred times the largest there is. More is memory for a wrong file.
const MAX_BYTES: u64 = 1 << 26;

fn read(path: &Path) -> Result<Book, Failure> {
    let wrong =
        |error: &dyn std::fmt::Display| Failure::new(format!("{}: {error}", path.display()));
    let bytes = read_file(path, MAX_BYTES).map_err(|error| wrong(&error))?;
    let mut book: Book = serde_json::from_slice(&bytes).map_err(|error| wrong(&error))?;
    if book.category.is_empty() {
        let stem = path.file_stem().unwrap_or_default();
        book.category = stem.to_string_lossy().into_owned();
    }
    Ok(book)
}

/// A number, written as a number or as a string.
pub(super) fn number(value: &Value) -> Option<f64> {
    match value {
        Value::String(text) => text.parse().ok(),
        other => other.as_f64(),
    }
}

/// The number `inputs[key]`.
pub(super) fn number_at(inputs: &Value, key: &str) -> Result<f64, String> {
    number(&inputs[key]).ok_or_else(|| format!("input {key} is {}, not a number", inputs[key]))
}

/// A pair of numbers.
pub(super) fn point(value: &Value) -> Option<Vec2> {
    match value.as_array()?.as_slice() {
        [x, y] => Some(vec2(number(x)?, number(y)?)),
        _ => None,
    }
}

/// The pair `inputs[key]`.
pub(super) fn point_at(inputs: &Value, key: &str) -> Result<Vec2, String> {
    point(&inputs[key]).ok_or_else(|| format!("input {key} is {}, not a pair", inputs[key]))
}

/// The list of pairs `inputs[key]`.
pub(super) fn points_at(inputs: &Value, key: &str) -> Result<Vec<Vec2>, String> {
    let list = inputs[key].as_array();
    list.and_then(|list| list.iter().map(point).collect())
        .ok_or_else(|| format!("input {key} is not a list of pairs"))
}

/// The list of numbers `inputs[key]`.
pub(super) fn numbers_at(inputs: &Value, key: &str) -> Result<Vec<f64>, String> {
    let list = inputs[key].as_array();
    list.and_then(|list| list.iter().map(number).collect())
        .ok_or_else(|| format!("input {key} is not a list of numbers"))
}

/// Every number, word or truth value inside a value, in order.
pub(super) fn flatten(value: &Value, each: &mut dyn FnMut(&Value)) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| flatten(item, each)),
        Value::Object(items) => items.values().for_each(|item| flatten(item, each)),
        other => each(other),
    }
}

/// A pair as JSON.
pub(super) fn pair(v: Vec2) -> Value {
    Value::from(vec![v.x, v.y])
}
