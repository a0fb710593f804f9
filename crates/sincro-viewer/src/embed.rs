//! The page inside another page: `report.html` opens without a server.

/// The page's program, built from `page/`.
pub const SCRIPT: &str = include_str!("../page/dist/viewer.js");
/// The page's style.
pub const STYLE: &str = include_str!("../page/dist/viewer.css");

/// A film as a piece of HTML with all that it takes to show it.
#[must_use]
pub fn replay(film_json: &str) -> String {
    format!(
        concat!(
            "<div id=\"sincro-viewer\" class=\"sv-embedded\"><noscript>The replay needs JavaScript; everything else on this page \
             does not.</noscript></div>\n<style>{}</style>\n<script type=\"application/json\" id=\"sincro-film\">{}</script>\n",
            "<script>{}</script>\n"
        ),
        STYLE,
        inert(film_json),
        SCRIPT.replace("</script", "<\\/script")
    )
}

/// JSON that no HTML parser finds a tag in.
#[must_use]
pub fn inert(json: &str) -> String {
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
        let back: serde_json::Value = serde_json::from_str(&inert(evil)).unwrap();
        assert_eq!(back["title"], "</script><script>alert(1)</script><!--");
    }
}
