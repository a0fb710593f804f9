//! The error of refused parameters.

use sincro_math::error::InvalidParameters;

#[test]
fn all_findings_are_listed_and_shown() {
    let findings = vec!["mass is -1".to_owned(), "length is not finite".to_owned()];
    let error = InvalidParameters::new(findings.clone());
    assert_eq!(error[..], findings[..]);
    assert_eq!(error.to_string(), "mass is -1; length is not finite");
    assert_eq!(error.into_iter().collect::<Vec<_>>(), findings);
}
