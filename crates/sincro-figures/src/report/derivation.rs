//! Equations of a scene as its README states them: the section `Equations` of a Markdown text as HTML.
//!
//! Of Markdown it knows what such a section is made of: paragraphs, indented and fenced blocks, lists, tables, headings
//! of a lower level; within a line code, bold text and links, of which the text remains. All else is shown as it is
//! written, and no markup passes through.

use crate::plot::escape;

/// Text of the section with a heading, without the heading; `None`: the text has no such section.
#[must_use]
pub fn section_of<'a>(markdown: &'a str, heading: &str) -> Option<&'a str> {
    let start = markdown.lines().scan(0, |at, line| {
        let start = *at;
        *at += line.len() + 1;
        Some((start, line))
    });
    let mut sections = start.filter(|(_, line)| line.starts_with("## "));
    let (found, line) = sections.find(|(_, line)| line.trim_start_matches('#').trim() == heading)?;
    let end = sections.next().map_or(markdown.len(), |(at, _)| at);
    Some(markdown.get(found + line.len()..end)?.trim_matches(['\r', '\n']))
}

/// Kind of a block of lines.
#[derive(Clone, Copy, PartialEq)]
enum Block {
    Paragraph,
    Preformatted,
    Item,
    Heading,
}

/// The section as HTML.
pub(super) fn html(section: &str) -> String {
    let (mut text, mut block, mut lines) = (String::new(), Block::Paragraph, Vec::new());
    let mut is_fenced = false;
    for line in section.lines() {
        if line.starts_with("```") {
            flush(&mut text, block, &mut lines);
            is_fenced = !is_fenced;
            block = Block::Preformatted;
            continue;
        }
        if !is_fenced && line.trim().is_empty() {
            match block {
                Block::Preformatted => lines.push(""),
                _ => flush(&mut text, block, &mut lines),
            }
            continue;
        }
        let (kind, content) = if is_fenced { (Block::Preformatted, line) } else { kind_of(line, block, &lines) };
        if kind != block || kind == Block::Item && content.len() != line.len() || kind == Block::Heading {
            flush(&mut text, block, &mut lines);
        }
        block = kind;
        lines.push(content);
    }
    flush(&mut text, block, &mut lines);
    text
}

/// Kind of a line and its content, after the lines of the present block.
fn kind_of<'a>(line: &'a str, block: Block, lines: &[&str]) -> (Block, &'a str) {
    if let Some(item) = line.strip_prefix("- ") {
        (Block::Item, item)
    } else if let Some(code) = line.strip_prefix("    ") {
        (Block::Preformatted, code)
    } else if line.starts_with('|') {
        (Block::Preformatted, line)
    } else if line.starts_with('#') {
        (Block::Heading, line.trim_start_matches('#').trim())
    } else if block == Block::Item && !lines.is_empty() && line.starts_with("  ") {
        (Block::Item, line)
    } else {
        (Block::Paragraph, line)
    }
}

fn flush(text: &mut String, block: Block, lines: &mut Vec<&str>) {
    while lines.last().is_some_and(|line| line.is_empty()) {
        lines.pop();
    }
    if lines.is_empty() {
        return;
    }
    *text += &match block {
        Block::Preformatted => {
            let lines: Vec<String> = lines.iter().map(|line| escape(line)).collect();
            format!("<pre class=\"equations\">{}</pre>\n", lines.join("\n"))
        }
        Block::Paragraph => format!("<p>{}</p>\n", inline(&lines.join(" "))),
        Block::Item => format!("<p class=\"item\">{}</p>\n", inline(&lines.join(" "))),
        Block::Heading => format!("<h3>{}</h3>\n", inline(&lines.join(" "))),
    };
    lines.clear();
}

/// A line with code, bold text and the text of links.
fn inline(line: &str) -> String {
    let parts = line.split('`').enumerate();
    parts.map(|(k, part)| if k % 2 == 1 { format!("<code>{}</code>", escape(part)) } else { words(part) }).collect()
}

fn words(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('[') {
        plain += before;
        match after.split_once("](").and_then(|(label, tail)| Some((label, tail.split_once(')')?.1))) {
            Some((label, tail)) if !label.contains('[') => {
                plain += label;
                rest = tail;
            }
            _ => {
                plain.push('[');
                rest = after;
            }
        }
    }
    plain += rest;
    let parts: Vec<&str> = plain.split("**").collect();
    let is_paired = parts.len() % 2 == 1;
    let bold = |(k, part): (usize, &&str)| if k % 2 == 1 { format!("<b>{}</b>", escape(part)) } else { escape(part) };
    if is_paired { parts.iter().enumerate().map(bold).collect() } else { escape(&plain) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const README: &str = "# a scene\n\n## Equations\n\nThe law of [Hooke](hooke.md), **linear**:\n\n    F = k·x\n\n    E = ½·k·x²\n\n\
                          - `x` from rest\n- k > 0\n\n## Variables\n\nF = 3\n";

    #[test]
    fn a_section_ends_at_the_next_one() {
        let section = section_of(README, "Equations").unwrap();
        assert!(section.starts_with("The law") && section.ends_with("k > 0"), "{section:?}");
        assert_eq!(section_of(README, "Variables"), Some("F = 3"));
        assert_eq!(section_of(README, "Results"), None);
    }

    #[test]
    fn equations_are_preformatted_and_markup_is_escaped() {
        let text = html(section_of(README, "Equations").unwrap());
        assert!(text.contains("<p>The law of Hooke, <b>linear</b>:</p>"), "{text}");
        assert!(text.contains("<pre class=\"equations\">F = k·x\n\nE = ½·k·x²</pre>"), "{text}");
        assert!(
            text.contains("<p class=\"item\"><code>x</code> from rest</p>\n<p class=\"item\">k &gt; 0</p>"),
            "{text}"
        );
        assert!(html("a <script> [b] ** c").contains("a &lt;script&gt; [b] ** c"));
        assert!(html("```\n| x |\n\nF <= 1\n```").contains("<pre class=\"equations\">| x |\n\nF &lt;= 1</pre>"));
    }
}
