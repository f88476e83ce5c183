//! "Did you mean …": the nearest of several names, and lists of them.

/// Number of names that are listed.
const LISTED: usize = 12;

/// Returns the help for the unknown name `given`: the nearest of `names`, and a list of them under `title`. Empty without names.
pub(crate) fn suggestion<'a>(given: &str, title: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names: Vec<&str> = names.into_iter().filter(|name| !name.is_empty()).collect();
    if names.is_empty() {
        return format!("there are no {title}");
    }
    let nearest = names.iter().map(|name| (distance(given, name), *name)).min();
    let near =
        nearest.filter(|&(far, name)| far <= 1 + given.len().max(name.len()) / 4).map(|(_, name)| name);
    // The likely ones first, where not all are listed.
    if names.len() > LISTED {
        names.sort_by_key(|name| distance(given, name));
    }
    let more = names.len().saturating_sub(LISTED);
    names.truncate(LISTED);
    let list = names.join(", ");
    let list = if more > 0 { format!("{list} and {more} more") } else { list };
    match near {
        Some(near) => format!("did you mean \"{near}\"? ({title}: {list})"),
        None => format!("{title}: {list}"),
    }
}

/// Returns the number of letters to insert, delete, replace or swap with the next, ignoring case; names are cut after 64 letters.
fn distance(a: &str, b: &str) -> usize {
    let letters = |text: &str| -> Vec<char> { text.chars().flat_map(char::to_lowercase).take(64).collect() };
    let (a, b) = (letters(a), letters(b));
    let mut before: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut next = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = row[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            next[j] = replaced.min(row[j] + 1).min(next[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                next[j] = next[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut row, next);
    }
    row[b.len()]
}
