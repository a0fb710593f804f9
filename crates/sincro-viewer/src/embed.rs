//! The page inside another page: `report.html` opens without a server.

/// The page's program, built from `page/`.
pub(crate) const SCRIPT: &str = include_str!("../page/dist/viewer.js");
/// Style sheet of the viewer's page.
pub(crate) const STYLE: &str = include_str!("../page/dist/viewer.css");

/// HTML element that shows a replay, with the viewer's program and style in it, for a page that opens without a server.
/// `film_json` is the text of [`Replay::to_json`](crate::replay::Replay::to_json).
#[must_use]
pub fn replay(film_json: &str) -> String {
    let script = SCRIPT.replace("</script", "<\\/script");
    section(film_json, "", &format!("<style>{STYLE}</style>"), &format!("<script>{script}</script>"))
}

/// HTML element that shows a replay as [`replay`] does, for many pages that stand together: program and style are the
/// files of [`assets`] in `folder`, a path relative to the page.
#[must_use]
pub fn linked_replay(film_json: &str, folder: &str) -> String {
    let lacks = format!(
        "<p>The replay needs <code>{SCRIPT_FILE}</code> and <code>{STYLE_FILE}</code>, which stand in <code>{folder}</code>; \
         <code>sincro view</code> shows the folder of this page without them.</p>"
    );
    let style = format!("<link rel=\"stylesheet\" href=\"{folder}/{STYLE_FILE}\">");
    section(film_json, &lacks, &style, &format!("<script src=\"{folder}/{SCRIPT_FILE}\"></script>"))
}

fn section(film_json: &str, before: &str, style: &str, script: &str) -> String {
    let opening = format!(
        "<div id=\"sincro-viewer\" class=\"sv-embedded\">{before}<noscript>The replay needs JavaScript; everything else on this page \
         does not.</noscript></div>\n"
    );
    let film = "\n<script type=\"application/json\" id=\"sincro-film\">";
    [&opening, style, film, &escape_for_html(film_json), "</script>\n", script, "\n"].concat()
}

/// Names of the files of [`linked_replay`].
const SCRIPT_FILE: &str = "viewer.js";
const STYLE_FILE: &str = "viewer.css";

/// Files that pages with a [`linked_replay`] need in its folder: name and content of the program, then of the style
/// sheet.
#[must_use]
pub fn assets() -> [(&'static str, &'static str); 2] {
    [(SCRIPT_FILE, SCRIPT), (STYLE_FILE, STYLE)]
}

/// JSON that no HTML parser finds a tag in.
#[must_use]
pub(crate) fn escape_for_html(json: &str) -> String {
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_ends_the_script() {
        let evil = "{\"title\":\"</script><script>alert(1)</script><!--\"}";
        let page = replay(evil);
        assert!(!page.contains("alert(1)</script>") && !page.contains("<!--"), "a tag came through");
        let back: serde_json::Value = serde_json::from_str(&escape_for_html(evil)).unwrap();
        assert_eq!(back["title"], "</script><script>alert(1)</script><!--");
    }
}
