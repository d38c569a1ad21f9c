//! Settings laid over a file: from `body.ball.mass` to the place in the tree.

use core::ops::Range;
use std::borrow::Cow;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Problem, nearest};
use crate::model::PARAMETERS;

/// Lays `key = value` over the tree; the value counts as standing `offset` bytes into the text.
///
/// On failure: the field that is wrong, and why.
pub(crate) fn insert<'a>(
    tree: &mut DeTable<'a>,
    key: &'a str,
    value: &'a str,
    offset: usize,
) -> Result<(), (String, Problem)> {
    // What is no TOML value is a bare word: `settings.pairs=none`.
    let parsed = DeValue::parse(value)
        .unwrap_or_else(|_| Spanned::new(0..value.len(), DeValue::String(Cow::Borrowed(value))));
    let parsed = shifted(parsed, offset);
    let path = full_path(key);
    let Some((last, parents)) = path.split_last() else {
        let problem = Problem::MissingField("a key before the =".to_owned());
        return Err((String::new(), problem));
    };
    let mut place = Slot::Table(tree);
    for (depth, step) in parents.iter().enumerate() {
        place = place
            .enter(step, offset)
            .map_err(|problem| (path[..=depth].join("."), problem))?;
    }
    place
        .put(last, parsed)
        .map_err(|problem| (path.join("."), problem))
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
