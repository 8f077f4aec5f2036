#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;
use crate::schema::Schema;
use crate::study::keys::MEASURE as STUDY_MEASURE;
use crate::table::Table;
use crate::tree::Document;
use crate::wall::motion::SERVO;
use crate::{
    bond, bond_failure, clusters, contact, initial, load, measure, replacement, root, run, support,
    test, wall,
};

static SCHEMAS: [&Schema; 17] = [
    &root::SCENE,
    &run::RUN,
    &contact::CONTACT,
    &bond::BOND,
    &bond::DAMPING,
    &bond_failure::FAILURE,
    &wall::WALL,
    &SERVO,
    &initial::INITIAL,
    &support::SUPPORT,
    &load::LOAD,
    &replacement::REPLACEMENT,
    &replacement::RESTORE,
    &clusters::CLUSTERS,
    &test::TEST,
    &measure::MEASURE,
    &STUDY_MEASURE,
];

#[test]
fn every_old_key_is_refused_with_the_new_one() {
    for (title, old, new) in RENAMED {
        let has_new = |schema: &&Schema| schema.title == title && schema.key(new).is_some();
        let schema = SCHEMAS.into_iter().find(has_new);
        let schema = schema.unwrap_or_else(|| panic!("{title} has no {new}"));
        assert!(schema.key(old).is_none(), "{old} is a key again");
        let text = format!("# Of {title}\n{old} = 1\n");
        let document = Document::parse("scene.toml", &text).unwrap();
        let table = Table::root(&document, schema).unwrap();
        let error = table.refuse_unknown().unwrap_err().to_string();
        let expected = format!("scene.toml:2: {old} is now called {new}; write ");
        assert!(error.starts_with(&expected), "{error}");
        assert!(error[expected.len()..].contains(new), "{error}");
    }
}

#[test]
fn keys_that_are_gone_are_refused_with_the_reason() {
    for (title, old, why) in REMOVED {
        let is_of = |schema: &&Schema| schema.title == title;
        let schema = SCHEMAS.into_iter().find(is_of).unwrap();
        assert!(schema.key(old).is_none(), "{old} is a key again");
        let document = Document::parse("scene.toml", &format!("{old} = 1\n")).unwrap();
        let table = Table::root(&document, schema).unwrap();
        let error = table.refuse_unknown().unwrap_err().to_string();
        let expected = format!("scene.toml:1: {old} is no longer a key; {why}");
        assert_eq!(error, expected);
    }
}
