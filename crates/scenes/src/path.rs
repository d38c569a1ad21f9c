//! Fields by their path, and the places of fields in the text.

use core::fmt;
use core::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A field of a scene file: `body[2].shape.polygon[3]`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct FieldPath(Vec<Step>);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Step {
    Key(String),
    Index(usize),
}

impl FieldPath {
    /// The field `key` of the root.
    pub(crate) fn root(key: &str) -> Self {
        Self::default().key(key)
    }

    /// The field `key` of this table.
    #[must_use]
    pub(crate) fn key(&self, key: &str) -> Self {
        self.with(Step::Key(key.to_owned()))
    }

    /// Item `index` of this list.
    #[must_use]
    pub(crate) fn index(&self, index: usize) -> Self {
        self.with(Step::Index(index))
    }

    fn with(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

/// The number of a table in a list like `[[body]]` is left out: the line says which one is meant.
impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of_tables =
            matches!(self.0.first(), Some(Step::Key(key)) if LISTS.contains(&key.as_str()));
        for (depth, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) if depth == 0 => f.write_str(key)?,
                Step::Key(key) => write!(f, ".{key}")?,
                Step::Index(_) if depth == 1 && of_tables => {}
                Step::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// Fields of the root that are lists of tables.
const LISTS: [&str; 7] = [
    "body",
    "field",
    "stack",
    "pyramid",
    "grid",
    "population",
    "pair",
];

/// The field that a stretch of the text belongs to: the deepest with the stretch as its key or value, else the smallest
/// around it.
pub(crate) fn field_at(root: &DeTable<'_>, span: &Range<usize>) -> Option<FieldPath> {
    let mut search = Search {
        span,
        here: FieldPath::default(),
        exact: None,
        around: None,
    };
    search.table(root);
    search.exact.or(search.around.map(|(_, path)| path))
}

/// A walk over all fields. Only the path of the present one is kept: files may have millions of numbers.
struct Search<'s> {
    span: &'s Range<usize>,
    here: FieldPath,
    exact: Option<FieldPath>,
    /// Length of its value, and the field.
    around: Option<(usize, FieldPath)>,
}

impl Search<'_> {
    fn table(&mut self, table: &DeTable<'_>) {
        for (key, value) in table.iter() {
            let step = Step::Key(key.get_ref().to_string());
            self.visit(step, Some(&key.span()), value);
        }
    }

    fn visit(&mut self, step: Step, key: Option<&Range<usize>>, value: &Spanned<DeValue<'_>>) {
        self.here.0.push(step);
        let place = value.span();
        if key == Some(self.span) || place == *self.span {
            self.exact = Some(self.here.clone());
        } else if place.start <= self.span.start && self.span.end <= place.end {
            let smallest = self
                .around
                .as_ref()
                .map_or(usize::MAX, |(length, _)| *length);
            if place.len() < smallest {
                self.around = Some((place.len(), self.here.clone()));
            }
        }
        match value.get_ref() {
            DeValue::Table(table) => self.table(table),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    self.visit(Step::Index(index), None, item);
                }
            }
            _ => {}
        }
        self.here.0.pop();
    }
}

/// Where the value of a field starts; for one that is not in the text, the nearest table or list around it.
pub(crate) fn start_of(root: &DeTable<'_>, field: &FieldPath) -> Option<usize> {
    let mut steps = field.0.iter();
    let Some(Step::Key(first)) = steps.next() else {
        return None;
    };
    let mut here = root.get(first.as_str())?;
    for step in steps {
        let deeper = match (step, here.get_ref()) {
            (Step::Key(key), DeValue::Table(table)) => table.get(key.as_str()),
            (Step::Index(index), DeValue::Array(items)) => items.get(*index),
            _ => None,
        };
        match deeper {
            Some(deeper) => here = deeper,
            None => break,
        }
    }
    Some(here.span().start)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "version = 1\n[[body]]\nname = 'a'\n[[body]]\nshape = { polygon = [[1, 2], [3, 4]] }\n";

    #[test]
    fn fields_and_places_belong_together() {
        let root = DeTable::parse(TEXT).unwrap();
        let point = FieldPath::root("body")
            .index(1)
            .key("shape")
            .key("polygon")
            .index(1);
        assert_eq!(point.to_string(), "body.shape.polygon[1]");
        let start = start_of(root.get_ref(), &point).unwrap();
        assert_eq!(&TEXT[start..start + 6], "[3, 4]");
        assert_eq!(field_at(root.get_ref(), &(start..start + 6)), Some(point));
        // What is not written is at its table.
        let mass = FieldPath::root("body").index(0).key("mass");
        assert_eq!(start_of(root.get_ref(), &mass), TEXT.find("[[body]]"));
        assert_eq!(start_of(root.get_ref(), &FieldPath::root("nothing")), None);
    }
}
