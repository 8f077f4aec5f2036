//! How the values of keys are read and shown: numbers, vectors, text, true and false, words.

use super::direction::{direction, rotation};
use super::field::{Field, remedy};
use super::numbers::{quantity, vector, with_unit};
use super::schema::{Key, Kind, Unless, Word};
use super::table::Read;
use dem_io::diagnostic::Result;

/// Infinite if the key is left out and has no default.
impl Read for f64 {
    fn given(field: &Field<'_>, key: &Key) -> Result<Self> {
        if let (Kind::Auto(dimension), true) = (&key.kind, field.is_word()) {
            let limit = format!("\"auto\" or {}", dimension.named());
            return Err(field.wrong(&limit, remedy(key)));
        }
        field.within_limits(key)
    }

    fn unless_given(usual: Unless) -> Option<Self> {
        match usual {
            Unless::Number(usual) => Some(usual),
            Unless::Absent(_) => Some(Self::INFINITY),
            _ => None,
        }
    }

    fn told(&self, key: &Key) -> String {
        if self.is_infinite() {
            return key.usual();
        }
        quantity(*self, key.unit())
    }
}

/// Three quantities, a direction of length 1, or a rotation vector in rad.
impl Read for [f64; 3] {
    fn given(field: &Field<'_>, key: &Key) -> Result<Self> {
        match &key.kind {
            Kind::Direction(what) => direction(field, what),
            Kind::Table(_) => rotation(field),
            _ => field.vector(key.dimension()),
        }
    }

    fn unless_given(usual: Unless) -> Option<Self> {
        match usual {
            Unless::Number(usual) => Some([usual; 3]),
            _ => None,
        }
    }

    fn told(&self, key: &Key) -> String {
        let unit = match key.kind {
            Kind::Table(_) => "rad",
            _ => key.unit(),
        };
        vector(*self, unit)
    }
}

impl Read for String {
    fn given(field: &Field<'_>, _: &Key) -> Result<Self> {
        field.text().map(str::to_owned)
    }

    fn unless_given(_: Unless) -> Option<Self> {
        None
    }

    fn told(&self, _: &Key) -> String {
        self.clone()
    }
}

impl Read for Vec<String> {
    fn given(field: &Field<'_>, _: &Key) -> Result<Self> {
        let items = field.one_or_more()?;
        items
            .iter()
            .map(|item| item.text().map(str::to_owned))
            .collect()
    }

    fn unless_given(_: Unless) -> Option<Self> {
        Some(Self::new())
    }

    fn told(&self, key: &Key) -> String {
        match &self[..] {
            [] => key.usual(),
            names => names.join(", "),
        }
    }
}

impl Read for bool {
    fn given(field: &Field<'_>, _: &Key) -> Result<Self> {
        field.boolean()
    }

    fn unless_given(usual: Unless) -> Option<Self> {
        match usual {
            Unless::Boolean(usual) => Some(usual),
            _ => None,
        }
    }

    fn told(&self, _: &Key) -> String {
        self.to_string()
    }
}

/// 0 if the key is left out and has no default.
impl Read for u64 {
    fn given(field: &Field<'_>, key: &Key) -> Result<Self> {
        let number = match key.kind {
            Kind::Whole { least, most, .. } => field.whole(least, most, key.remedy),
            _ => field.whole(0, None, key.remedy),
        }?;
        if !key.allows(number as f64) {
            return Err(field.wrong(&key.limits_in_words(), key.remedy));
        }
        Ok(number)
    }

    fn unless_given(usual: Unless) -> Option<Self> {
        match usual {
            Unless::Number(usual) => Some(usual as Self),
            Unless::Absent(_) => Some(0),
            _ => None,
        }
    }

    fn told(&self, key: &Key) -> String {
        match (&key.kind, key.unless_given) {
            (_, Unless::Absent(what)) if *self == 0 => what.to_owned(),
            (Kind::Whole { of, .. }, _) => with_unit(&self.to_string(), of),
            _ => self.to_string(),
        }
    }
}

/// For a key whose largest number fits into 32 bits.
impl Read for u32 {
    fn given(field: &Field<'_>, key: &Key) -> Result<Self> {
        u64::given(field, key).map(|number| number as Self)
    }

    fn unless_given(usual: Unless) -> Option<Self> {
        u64::unless_given(usual).map(|number| number as Self)
    }

    fn told(&self, key: &Key) -> String {
        u64::from(*self).told(key)
    }
}

impl<T: Word> Read for T {
    fn given(field: &Field<'_>, _: &Key) -> Result<Self> {
        field.choice(T::WORDS)
    }

    fn unless_given(usual: Unless) -> Option<Self> {
        match usual {
            Unless::Word(usual) => {
                let found = T::WORDS.iter().find(|(word, _)| *word == usual);
                found.map(|(_, meant)| *meant)
            }
            _ => None,
        }
    }

    fn told(&self, _: &Key) -> String {
        let found = T::WORDS.iter().find(|(_, meant)| meant == self);
        found.map_or_else(String::new, |(word, _)| (*word).to_owned())
    }
}

/// None if the key is left out, or is "auto".
impl<T: Read> Read for Option<T> {
    fn given(field: &Field<'_>, key: &Key) -> Result<Self> {
        match key.kind {
            Kind::Auto(_) if field.is("auto") => Ok(None),
            _ => T::given(field, key).map(Some),
        }
    }

    fn unless_given(_: Unless) -> Option<Self> {
        Some(None)
    }

    fn told(&self, key: &Key) -> String {
        match self {
            Some(value) => value.told(key),
            None => key.usual(),
        }
    }
}
