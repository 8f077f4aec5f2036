//! Tables of which each key stands for one field, declared in one place.

/// Declares a table from one entry for each key: its struct with public fields, and its schema. The
/// comment of a field is the sentence of its key; its value is in SI, a direction of length 1.
///
/// An entry is `field: type =` and an entry of [`table_schema`](crate::schema::table_schema).
/// [`plain_table`] takes it with `by` a function that reads the value from the table.
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

        $crate::schema::table_schema! {
            $(#[doc = $about])+
            pub(crate) static $schema = $title;
            $(
                $(#[doc = $sentence])+
                $kind $(::<$word>)? ($key $(, $with)*) $(.$set($($to),*))*;
            )+
        }
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
