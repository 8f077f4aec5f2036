//! Sentences about bodies that differ only in the name of the body, told once.

/// Number of further bodies that are named.
const NAMED: usize = 3;

/// The sentences, in order; of those that say the same of several of these bodies the first, with
/// the names of the others.
pub fn told_once<'a>(
    sentences: Vec<String>,
    bodies: impl Iterator<Item = &'a String> + Clone,
) -> Vec<String> {
    let mut groups: Vec<(String, String, Vec<String>)> = Vec::new();
    for sentence in sentences {
        let own = bodies
            .clone()
            .find(|name| sentence.contains(&format!("'{name}'")));
        let Some(name) = own else {
            groups.push((String::new(), sentence, Vec::new()));
            continue;
        };
        let key = sentence.replace(&format!("'{name}'"), "''");
        let key = key.replace(&format!("bodies.{name}."), "bodies..");
        match groups.iter_mut().find(|(known, ..)| *known == key) {
            Some((.., others)) => others.push(format!("'{name}'")),
            None => groups.push((key, sentence, Vec::new())),
        }
    }
    let told = groups.into_iter().map(|(_, sentence, others)| {
        let named = others[..others.len().min(NAMED)].join(", ");
        match others.len() {
            0 => sentence,
            count if count <= NAMED => format!("{sentence}; the same holds for {named}"),
            count => format!("{sentence}; the same holds for {count} other bodies: {named}, ..."),
        }
    });
    told.collect()
}

#[cfg(test)]
mod tests {
    use super::told_once;

    #[test]
    fn what_holds_for_several_bodies_is_told_once() {
        let names: Vec<String> = (1..=13).map(|n| format!("ball-{n}")).collect();
        let about = |name: &str| format!("body '{name}' is odd: bodies.{name}.mass mends it");
        let mut sentences: Vec<String> = names.iter().map(|name| about(name)).collect();
        sentences.insert(1, "body 'ball-1' is large".to_owned());
        let told = told_once(sentences, names.iter());
        assert_eq!(
            told,
            [
                format!(
                    "{}; the same holds for 12 other bodies: 'ball-2', 'ball-3', 'ball-4', ...",
                    about("ball-1")
                ),
                "body 'ball-1' is large".to_owned()
            ]
        );
        let two = told_once(
            names[..2].iter().map(|name| about(name)).collect(),
            names.iter(),
        );
        assert_eq!(
            two,
            [format!("{}; the same holds for 'ball-2'", about("ball-1"))]
        );
        let apart = vec!["a".to_owned(), "a".to_owned()];
        assert_eq!(told_once(apart.clone(), names.iter()), apart);
    }
}
