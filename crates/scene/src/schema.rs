//! The schema of scenes and studies: a table lists its keys once, each with type, unit, default,
//! limits and one sentence. Reader, messages, listing, reference and JSON Schema are generated from
//! it.

use std::ops::Bound::{Excluded, Included, Unbounded};
use std::ops::{Bound, RangeBounds};

use super::numbers::{quantity, vector};
use dem_io::units::{Dimension, NUMBER};

/// A table and its keys.
pub(super) struct Schema {
    /// `[run]`, `[bodies.NAME]`; for a table within others, a description.
    pub(super) title: &'static str,
    /// One sentence.
    pub(super) doc: &'static str,
    pub(super) keys: &'static [Key],
}

impl Schema {
    pub(super) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The key at a path of a scene: `bodies.NAME.drop.height`.
    pub(super) fn key_at(&self, path: &str) -> Option<&'static Key> {
        let (name, rest) = path.split_once('.').unwrap_or((path, ""));
        let key = self.key(name)?;
        if rest.is_empty() {
            return Some(key);
        }
        key.kind.key_at(rest)
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.keys.iter().map(|key| key.name)
    }
}

/// A key of a table.
pub(super) struct Key {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) unless_given: Unless,
    /// Limits of numbers, in SI.
    pub(super) limits: (Bound<f64>, Bound<f64>),
    /// The remedy for a number outside the limits; empty: an example gives it.
    pub(super) remedy: &'static str,
    /// One sentence or two.
    pub(super) doc: &'static str,
}

/// The type of a value.
pub(super) enum Kind {
    /// A number of this dimension, with or without a unit.
    Quantity(&'static Dimension),
    /// "auto", or a number of this dimension.
    Auto(&'static Dimension),
    /// A number in the dimension of the quantity of `[measures.NAME]`.
    Measured,
    /// Three numbers of this dimension, along x, y and z.
    Vector(&'static Dimension),
    /// Three numbers that give a direction; its name in messages: "an axis".
    Direction(&'static str),
    /// A whole number from `least`, with its unit ("steps"); `most` is None if no message needs to
    /// name it.
    Whole {
        least: u64,
        most: Option<u64>,
        of: &'static str,
    },
    /// True or false.
    Boolean,
    /// Only true.
    True,
    /// One of these words.
    Word(fn() -> Vec<&'static str>),
    /// Text, and its meaning: "a file", "a name in [materials]".
    Text(&'static str),
    /// A list of at least one item.
    List(&'static Kind),
    /// A list of exactly these items.
    Row(&'static [Kind]),
    /// A table with these keys.
    Table(&'static Schema),
    /// A table with a value of this type for each of its names; the placeholder of the names:
    /// "NAME".
    Named(&'static str, &'static Kind),
    /// A table with these keys, and others with values of this type.
    Open(&'static Schema, &'static Kind),
    /// One of these types.
    Either(&'static [Kind]),
    /// A value defined by another file.
    Anything(&'static str),
}

impl Kind {
    /// A whole number from 1 that fits into 32 bits.
    pub(super) const COUNT: Self = Self::Whole {
        least: 1,
        most: Some(u32::MAX as u64),
        of: "",
    };

    /// The key at a path within a value of this type.
    fn key_at(&self, path: &str) -> Option<&'static Key> {
        match self {
            Self::Table(schema) => schema.key_at(path),
            Self::Open(schema, others) => {
                let other = || others.key_at(path.split_once('.')?.1);
                schema.key_at(path).or_else(other)
            }
            Self::Named(_, kind) => kind.key_at(path.split_once('.')?.1),
            Self::Either(kinds) => kinds.iter().find_map(|kind| kind.key_at(path)),
            _ => None,
        }
    }
}

/// The value of a key that is left out.
#[derive(Clone, Copy)]
pub(super) enum Unless {
    /// None: the scene is refused. An example of the value.
    Required(&'static str),
    /// The same in some cases, which the sentence names; otherwise there is no value.
    SometimesRequired(&'static str),
    /// This number, in SI, or three times this number for a vector.
    Number(f64),
    Word(&'static str),
    Boolean(bool),
    /// No value, and its meaning: "never".
    Absent(&'static str),
}

/// A value that stands for one of several words.
pub(super) trait Word: Copy + PartialEq + 'static {
    const WORDS: &'static [(&'static str, Self)];
}

/// The words of a list of words and values.
pub(super) fn words_of<T>(known: &[(&'static str, T)]) -> Vec<&'static str> {
    known.iter().map(|(word, _)| *word).collect()
}

fn words<T: Word>() -> Vec<&'static str> {
    words_of(T::WORDS)
}

impl Key {
    pub(super) const fn new(name: &'static str, kind: Kind, doc: &'static str) -> Self {
        Self {
            name,
            kind,
            unless_given: Unless::Absent("none"),
            limits: (Unbounded, Unbounded),
            remedy: "",
            doc,
        }
    }

    pub(super) const fn number(name: &'static str, doc: &'static str) -> Self {
        Self::new(name, Kind::Quantity(&NUMBER), doc)
    }

    pub(super) const fn quantity(
        name: &'static str,
        dimension: &'static Dimension,
        doc: &'static str,
    ) -> Self {
        Self::new(name, Kind::Quantity(dimension), doc)
    }

    /// Three numbers, zero unless given.
    pub(super) const fn vector(
        name: &'static str,
        dimension: &'static Dimension,
        doc: &'static str,
    ) -> Self {
        Self::new(name, Kind::Vector(dimension), doc).or(0.0)
    }

    /// A whole number from `least`.
    pub(super) const fn whole(name: &'static str, least: u64, doc: &'static str) -> Self {
        let (most, of) = (None, "");
        Self::new(name, Kind::Whole { least, most, of }, doc)
    }

    /// True or false.
    pub(super) const fn flag(name: &'static str, usual: bool, doc: &'static str) -> Self {
        let mut key = Self::new(name, Kind::Boolean, doc);
        key.unless_given = Unless::Boolean(usual);
        key
    }

    /// One of the words for `T`; `usual` unless given.
    pub(super) const fn word<T: Word>(
        name: &'static str,
        usual: &'static str,
        doc: &'static str,
    ) -> Self {
        Self::new(name, Kind::Word(words::<T>), doc).or_word(usual)
    }

    pub(super) const fn text(name: &'static str, what: &'static str, doc: &'static str) -> Self {
        Self::new(name, Kind::Text(what), doc)
    }

    /// The name of a group of particles that is there at the start.
    pub(super) const fn group(name: &'static str, doc: &'static str) -> Self {
        Self::text(name, "a group, a body or `all`", doc)
            .required("\"NAME\", a group, a body or \"all\"")
    }

    /// A table within the table.
    pub(super) const fn table(
        name: &'static str,
        keys: &'static Schema,
        doc: &'static str,
    ) -> Self {
        Self::new(name, Kind::Table(keys), doc)
    }

    /// A table within the table, with the sentence of its schema.
    pub(super) const fn documented(name: &'static str, keys: &'static Schema) -> Self {
        Self::table(name, keys, keys.doc)
    }

    /// The tables `[name.NAME]`, with the sentence of their schema.
    pub(super) const fn named(name: &'static str, tables: &'static Kind) -> Self {
        Self::named_by("NAME", name, tables)
    }

    /// The tables `[name.placeholder]`, with the sentence of their schema.
    pub(super) const fn named_by(
        placeholder: &'static str,
        name: &'static str,
        tables: &'static Kind,
    ) -> Self {
        let doc = match tables {
            Kind::Table(schema) => schema.doc,
            _ => "",
        };
        Self::new(name, Kind::Named(placeholder, tables), doc)
    }

    /// Makes the key required.
    pub(super) const fn required(mut self, example: &'static str) -> Self {
        self.unless_given = Unless::Required(example);
        self
    }

    /// Makes the key required in some cases.
    pub(super) const fn sometimes_required(mut self, example: &'static str) -> Self {
        self.unless_given = Unless::SometimesRequired(example);
        self
    }

    /// Sets the default to this number, in SI.
    pub(super) const fn or(mut self, number: f64) -> Self {
        self.unless_given = Unless::Number(number);
        self
    }

    pub(super) const fn or_word(mut self, word: &'static str) -> Self {
        self.unless_given = Unless::Word(word);
        self
    }

    /// Sets the default to no value, with the meaning `what`.
    pub(super) const fn otherwise(mut self, what: &'static str) -> Self {
        self.unless_given = Unless::Absent(what);
        self
    }

    pub(super) const fn positive(self) -> Self {
        self.within(Excluded(0.0), Unbounded)
    }

    pub(super) const fn not_negative(self) -> Self {
        self.within(Included(0.0), Unbounded)
    }

    pub(super) const fn up_to(self, most: f64) -> Self {
        self.within(Unbounded, Included(most))
    }

    pub(super) const fn within(mut self, low: Bound<f64>, high: Bound<f64>) -> Self {
        self.limits = (low, high);
        self
    }

    pub(super) const fn remedy(mut self, remedy: &'static str) -> Self {
        self.remedy = remedy;
        self
    }

    /// True if it is a number within the limits.
    pub(super) fn allows(&self, value: f64) -> bool {
        self.limits.contains(&value)
    }

    /// True for numbers whose limits leave out all below 0, and for whole ones.
    pub(super) fn is_never_negative(&self) -> bool {
        let from_zero = match self.limits.0 {
            Excluded(low) | Included(low) => low >= 0.0,
            Unbounded => false,
        };
        from_zero || matches!(self.kind, Kind::Whole { .. })
    }

    /// "more than 0 m", angles in degrees; empty without limits.
    pub(super) fn limits_in_words(&self) -> String {
        let (shown, unit): (fn(f64) -> f64, _) = match self.unit() {
            "rad" => (f64::to_degrees, "deg"),
            si => (|limit| limit, si),
        };
        let (low, high) = (self.limits.0.map(shown), self.limits.1.map(shown));
        let low = match low {
            Excluded(low) => Some(format!("more than {low}")),
            Included(low) => Some(format!("at least {low}")),
            Unbounded => None,
        };
        let high = match high {
            Excluded(high) => Some(format!("less than {high}")),
            Included(high) => Some(format!("at most {high}")),
            Unbounded => None,
        };
        let both: Vec<String> = low.into_iter().chain(high).collect();
        let words = both.join(" and ");
        if words.is_empty() {
            return words;
        }
        format!("{words} {unit}").trim_end().to_owned()
    }

    /// The dimension of its numbers; that of plain numbers if it has none.
    pub(super) fn dimension(&self) -> &'static Dimension {
        let of = |kind: &Kind| match kind {
            Kind::Quantity(dimension) | Kind::Auto(dimension) | Kind::Vector(dimension) => {
                Some(*dimension)
            }
            _ => None,
        };
        let found = match &self.kind {
            Kind::Either(kinds) => kinds.iter().find_map(of),
            kind => of(kind),
        };
        found.unwrap_or(&NUMBER)
    }

    /// The SI unit of its numbers; empty for plain ones.
    pub(super) fn unit(&self) -> &'static str {
        self.dimension().si
    }

    /// Its default, as shown in the listing of a scene.
    pub(super) fn usual(&self) -> String {
        match self.unless_given {
            Unless::Required(_) => "required".to_owned(),
            Unless::SometimesRequired(_) => "none".to_owned(),
            Unless::Number(usual) => match self.kind {
                Kind::Vector(_) => vector([usual; 3], self.unit()),
                Kind::Table(_) => vector([usual; 3], "rad"),
                Kind::Whole { of, .. } => quantity(usual, of),
                _ => quantity(usual, self.unit()),
            },
            Unless::Word(word) => word.to_owned(),
            Unless::Boolean(usual) => usual.to_string(),
            Unless::Absent(what) => what.to_owned(),
        }
    }
}

/// Declares the schema of a table: its sentence as a comment, its title, then an entry for each key
/// with its sentence as a comment. An entry is `kind("key", ...)`, with a constructor of [`Key`]
/// without its sentence; or, without a comment, a constant or a constructor that gives the
/// sentence.
macro_rules! table_schema {
    (
        $(#[doc = $about:literal])+
        $visibility:vis static $schema:ident = $title:literal;
        $(
            $(#[doc = $sentence:literal])*
            $kind:ident $(::<$word:ty>)? $(($($with:expr),*))? $(.$set:ident($($to:expr),*))*;
        )+
    ) => {
        $(#[doc = $about])+
        $visibility static $schema: $crate::schema::Schema = $crate::schema::Schema {
            title: $title,
            doc: $crate::schema::sentence!($($about)+),
            keys: &[$(
                $crate::schema::key!(
                    [$($sentence)*] $kind $(::<$word>)? $(($($with),*))? $(.$set($($to),*))*
                ),
            )+],
        };
    };
}

macro_rules! key {
    ([] $constant:ident) => {
        $constant
    };
    ([] $kind:ident ($($with:expr),*) $(.$set:ident($($to:expr),*))*) => {
        $crate::schema::Key::$kind($($with),*) $(.$set($($to),*))*
    };
    (
        [$($sentence:literal)+]
        $kind:ident $(::<$word:ty>)? ($($with:expr),*) $(.$set:ident($($to:expr),*))*
    ) => {
        $crate::schema::Key::$kind $(::<$word>)? (
            $($with,)*
            $crate::schema::sentence!($($sentence)+),
        )
        $(.$set($($to),*))*
    };
}

/// The lines of a comment as one.
macro_rules! sentence {
    ($($line:literal)+) => {
        concat!($($line),+).trim_ascii_start()
    };
}

pub(crate) use {key, sentence, table_schema};
