//! The schema of each kind of text in RELAX NG, made from the tables.
//!
//! For editors that complete and check XML, and for documentation. It describes a text without its meaning: that a name exists, or that a
//! take belongs to a model, is checked by this library alone. Attributes and elements of other namespaces are allowed everywhere.

use super::row::{AttributeRow, ElementRow};
use super::{SCRIPTS, Vocabulary};
use std::fmt::Write;

/// Returns the schema of scripts as a text in the XML syntax of RELAX NG.
pub fn schema() -> String {
    SCRIPTS.schema()
}

impl Vocabulary {
    /// Returns the schema as a text in the XML syntax of RELAX NG.
    pub fn schema(&self) -> String {
        written(self)
    }
}

fn written(vocabulary: &Vocabulary) -> String {
    let mut out = String::from(concat!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
        "<grammar xmlns=\"http://relaxng.org/ns/structure/1.0\"",
        " xmlns:a=\"http://relaxng.org/ns/compatibility/annotations/1.0\"",
        " datatypeLibrary=\"http://www.w3.org/2001/XMLSchema-datatypes\">\n",
    ));
    let _ = writeln!(out, "  <start><ref name=\"{}\"/></start>", vocabulary.root.name);
    for row in vocabulary.elements {
        define(&mut out, vocabulary, row);
    }
    out.push_str(FOREIGN);
    out.push_str("</grammar>\n");
    out
}

/// Definitions of what other namespaces may add.
const FOREIGN: &str = concat!(
    "  <define name=\"foreign-attributes\"><zeroOrMore><attribute>\n",
    "    <anyName><except><nsName ns=\"\"/></except></anyName>\n",
    "  </attribute></zeroOrMore></define>\n",
    "  <define name=\"foreign-element\"><element>\n",
    "    <anyName><except><nsName ns=\"\"/></except></anyName><ref name=\"anything\"/>\n",
    "  </element></define>\n",
    "  <define name=\"anything\"><zeroOrMore><choice>\n",
    "    <attribute><anyName/></attribute><text/>\n",
    "    <element><anyName/><ref name=\"anything\"/></element>\n",
    "  </choice></zeroOrMore></define>\n",
);

fn define(out: &mut String, vocabulary: &Vocabulary, row: &'static ElementRow) {
    let _ = writeln!(out, "  <define name=\"{0}\"><element name=\"{0}\">", row.name);
    let _ = writeln!(out, "    <a:documentation>{}</a:documentation>", escaped(row.help));
    let chosen = |attribute: &&AttributeRow| row.one_of.contains(&attribute.name);
    for attribute in row.rows().filter(|attribute| !chosen(attribute)) {
        let text = self::attribute(attribute);
        let _ = match attribute.required {
            true => writeln!(out, "    {text}"),
            false => writeln!(out, "    <optional>{text}</optional>"),
        };
    }
    if !row.one_of.is_empty() {
        let _ = writeln!(out, "    <choice>");
        for attribute in row.rows().filter(chosen) {
            let _ = writeln!(out, "      {}", self::attribute(attribute));
        }
        let _ = writeln!(out, "    </choice>");
    }
    out.push_str(
        "    <ref name=\"foreign-attributes\"/>\n    <zeroOrMore><choice><ref name=\"foreign-element\"/>",
    );
    for child in vocabulary.children_of(row) {
        let _ = write!(out, "<ref name=\"{}\"/>", child.name);
    }
    out.push_str("</choice></zeroOrMore>\n  </element></define>\n");
}

fn attribute(row: &AttributeRow) -> String {
    let value = match (row.value.choices, row.value.pattern) {
        ([], "") => "<data type=\"string\"><param name=\"minLength\">1</param></data>".to_owned(),
        ([], pattern) => {
            format!("<data type=\"string\"><param name=\"pattern\">{}</param></data>", escaped(pattern))
        }
        (choices, _) => {
            let values: String =
                choices.iter().map(|choice| format!("<value>{}</value>", escaped(choice))).collect();
            format!("<choice>{values}</choice>")
        }
    };
    let default = match row.default {
        "" => String::new(),
        default => format!(" a:defaultValue=\"{}\"", escaped(default)),
    };
    format!(
        "<attribute name=\"{}\"{default}><a:documentation>{}</a:documentation>{value}</attribute>",
        row.name,
        escaped(row.help)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
