//! An event as a line of text: its name, then its payload as JSON.

use dragonfly_document::edit::TakeEvent;
use serde_json::Value;

/// Returns the text of an event: `step {"foot":"left"}`.
pub(super) fn text_of(event: &TakeEvent) -> String {
    event.payload.as_ref().map_or(event.name.clone(), |payload| format!("{} {payload}", event.name))
}

/// Returns the name and the payload in a text; `None` without a name, or where the payload is no JSON.
pub(super) fn parsed(text: &str) -> Option<(String, Option<Value>)> {
    let start = text.find(['{', '[']).unwrap_or(text.len());
    let (name, payload) = text.split_at(start);
    let name = name.trim();
    let payload = payload.trim();
    let value = if payload.is_empty() { None } else { Some(serde_json::from_str(payload).ok()?) };
    (!name.is_empty()).then(|| (name.to_owned(), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_text_gives_name_and_payload_and_back() {
        let event = |payload| TakeEvent { time: 0.0, name: "step".to_owned(), payload };
        let payload = Some(json!({ "foot": "left", "at": [1, 2.5] }));
        assert_eq!(parsed(&text_of(&event(payload.clone()))), Some(("step".to_owned(), payload)));
        assert_eq!(parsed(&text_of(&event(None))), Some(("step".to_owned(), None)));
        assert_eq!(parsed("  left foot  [1] "), Some(("left foot".to_owned(), Some(json!([1])))));
    }

    #[test]
    fn a_text_without_a_name_or_with_broken_json_is_none() {
        for text in ["", "  ", "{}", "step {", "step {\"a\":}", "step {} x"] {
            assert_eq!(parsed(text), None, "{text}");
        }
    }
}
