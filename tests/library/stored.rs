//! The plain types that a user stores come back as they were, and never as what they could not be.

use glam::DVec2;
use proptest::prelude::*;
use twelvefold::{Amount, Domain, Limits, Sample};

fn back<T: serde::Serialize + serde::de::DeserializeOwned>(stored: &T) -> T {
    serde_json::from_str(&serde_json::to_string(stored).unwrap()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn what_is_stored_comes_back(
        (x, y) in (-1e6..1e6, -1e6..1e6), (w, h) in (1e-3..1e6, 1e-3..1e6), rank: u64, n in 0.0..1e9,
    ) {
        let domain = Domain::new(DVec2::new(x, y), DVec2::new(w, h)).unwrap();
        prop_assert_eq!(back(&domain), domain);
        prop_assert_eq!(back(&Amount::Points(n)), Amount::Points(n));
        prop_assert_eq!(back(&Amount::Density(n)), Amount::Density(n));
        let limits = Limits { points: rank, tiles: !rank };
        prop_assert_eq!(back(&limits), limits);
        let sample = Sample { position: [x, y], rank };
        prop_assert_eq!(back(&sample), sample);
    }
}

#[test]
fn a_rectangle_that_is_no_domain_is_refused() {
    for text in [
        r#"{"min":[0.0,0.0],"size":[0.0,1.0]}"#,
        r#"{"min":[0.0,0.0],"size":[1.0,-1.0]}"#,
        r#"{"min":[1e200,0.0],"size":[1.0,1.0]}"#,
    ] {
        let error = serde_json::from_str::<Domain>(text).unwrap_err().to_string();
        assert!(error.contains("domain"), "{error}");
    }
    assert_eq!(
        serde_json::to_string(&Domain::UNIT).unwrap(),
        r#"{"min":[0.0,0.0],"size":[1.0,1.0]}"#
    );
}
