//! Fields by their path, and the places of fields in the text.

use core::fmt;
use core::ops::Range;

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

    /// The table or list that holds this field.
    fn parent(&self) -> Self {
        let mut steps = self.0.clone();
        steps.pop();
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
const LISTS: [&str; 6] = ["body", "field", "stack", "pyramid", "grid", "population"];

/// Where every field of a document is: in the order of the tree, parents before children.
pub(crate) struct Places(Vec<Entry>);

struct Entry {
    path: FieldPath,
    key: Option<Range<usize>>,
    value: Range<usize>,
}

impl Places {
    pub(crate) fn of(root: &DeTable<'_>) -> Self {
        let mut places = Self(Vec::new());
        places.add_table(&FieldPath::default(), root);
        places
    }

    fn add_table(&mut self, path: &FieldPath, table: &DeTable<'_>) {
        for (key, value) in table.iter() {
            let path = path.key(key.get_ref());
            self.add(path, Some(key.span()), value.span(), value.get_ref());
        }
    }

    fn add(
        &mut self,
        path: FieldPath,
        key: Option<Range<usize>>,
        span: Range<usize>,
        value: &DeValue<'_>,
    ) {
        self.0.push(Entry {
            path: path.clone(),
            key,
            value: span,
        });
        match value {
            DeValue::Table(table) => self.add_table(&path, table),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    self.add(path.index(index), None, item.span(), item.get_ref());
                }
            }
            _ => {}
        }
    }

    /// The field that a stretch of the text belongs to: the deepest whose key or value it is,
    /// else the smallest around it.
    pub(crate) fn field_at(&self, span: &Range<usize>) -> Option<&FieldPath> {
        let exact = |entry: &&Entry| entry.key.as_ref() == Some(span) || &entry.value == span;
        let around =
            |entry: &&Entry| entry.value.start <= span.start && span.end <= entry.value.end;
        let found = self.0.iter().rfind(exact).or_else(|| {
            self.0
                .iter()
                .filter(around)
                .min_by_key(|entry| entry.value.len())
        });
        found.map(|entry| &entry.path)
    }

    /// Where the value of a field starts; for a field that is not in the text, the nearest table around it.
    pub(crate) fn start_of(&self, field: &FieldPath) -> Option<usize> {
        let mut field = field.clone();
        while !field.0.is_empty() {
            if let Some(entry) = self.0.iter().find(|entry| entry.path == field) {
                return Some(entry.value.start);
            }
            field = field.parent();
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "version = 1\n[[body]]\nname = 'a'\n[[body]]\nshape = { polygon = [[1, 2], [3, 4]] }\n";

    #[test]
    fn fields_and_places_belong_together() {
        let root = DeTable::parse(TEXT).unwrap();
        let places = Places::of(root.get_ref());
        let point = FieldPath::root("body")
            .index(1)
            .key("shape")
            .key("polygon")
            .index(1);
        assert_eq!(point.to_string(), "body.shape.polygon[1]");
        let start = places.start_of(&point).unwrap();
        assert_eq!(&TEXT[start..start + 6], "[3, 4]");
        assert_eq!(places.field_at(&(start..start + 6)), Some(&point));
        // What is not written is at its table.
        let mass = FieldPath::root("body").index(0).key("mass");
        assert_eq!(places.start_of(&mass), TEXT.find("[[body]]"));
        assert_eq!(places.start_of(&FieldPath::root("nothing")), None);
    }
}
