//! Tables of which each key stands for one field, declared in one place.

/// Declares a table from one entry for each key: its struct with public fields, and its schema. The
/// comment of a field is the sentence of its key.
///
/// An entry is `field: type = kind("key", ...)`, with a constructor of
/// [`Key`](crate::schema::Key) without its sentence. [`plain_table`] takes it with `by` a function
/// that reads the value from the table.
macro_rules! keyed_struct {
    (
        $schema:ident = $title:literal;
        $(#[doc = $about:literal])+
        #[derive($($derived:ident),+)]
        pub struct $of:ident {
            $(
                $(#[doc = $sentence:literal])+
                $field:ident: $type:ty = $kind:ident $(::<$word:ty>)? ($key:literal $(, $with:expr)*)
                    $(.$set:ident($($to:expr),*))* $(, by $read:ident)?;
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive($($derived),+)]
        pub struct $of {
            $($(#[doc = $sentence])+ pub $field: $type,)+
        }

        pub(crate) static $schema: $crate::schema::Schema = $crate::schema::Schema {
            title: $title,
            doc: concat!($($about),+).trim_ascii_start(),
            keys: &[$(
                $crate::schema::Key::$kind $(::<$word>)? (
                    $key,
                    $($with,)*
                    concat!($($sentence),+).trim_ascii_start(),
                )
                $(.$set($($to),*))*,
            )+],
        };
    };
}

/// Declares a [`keyed_struct`], its reader `read` and its listing `list`.
macro_rules! plain_table {
    ($($table:tt)+) => {
        $crate::plain_table::keyed_struct! { $($table)+ }
        $crate::plain_table::read_and_list! { $($table)+ }
    };
}

macro_rules! read_and_list {
    (
        $schema:ident = $title:literal;
        $(#[$about:meta])+
        pub struct $of:ident {
            $(
                $(#[$sentence:meta])+
                $field:ident: $type:ty = $kind:ident $(::<$word:ty>)? ($key:literal $(, $with:expr)*)
                    $(.$set:ident($($to:expr),*))* $(, by $read:ident)?;
            )+
        }
    ) => {
        impl $of {
            pub(crate) fn read(
                table: &$crate::table::Table<'_>,
            ) -> dem_io::diagnostic::Result<Self> {
                Ok(Self {
                    $($field: $crate::plain_table::read_value!(table, $key $(, $read)?),)+
                })
            }

            pub(crate) fn list(&self, listing: &mut $crate::listing::Listing) {
                $(listing.value($key, &self.$field);)+
            }
        }
    };
}

/// The value of a key, read as its schema says or by a function.
macro_rules! read_value {
    ($table:ident, $key:literal) => {
        $table.read($key)?
    };
    ($table:ident, $key:literal, $read:ident) => {
        $read($table)?
    };
}

pub(crate) use {keyed_struct, plain_table, read_and_list, read_value};
