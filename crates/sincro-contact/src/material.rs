//! Contact properties of surfaces, and the contact law of two of them.

/// Contact properties of one surface; those of a pair follow from [`Material::with`].
///
/// ```
/// use sincro_contact::Material;
///
/// let steel = Material { friction: 0.4, restitution: 0.6, stiffness: 2e6, ..Material::default() };
/// let rubber = Material { friction: 0.9, restitution: 0.3, stiffness: 1e5, ..Material::default() };
/// // the law of the pair: geometric mean of the friction, compliances add up
/// let pair = steel.with(&rubber);
/// assert!((pair.friction - 0.6).abs() < 1e-15 && pair.restitution == 0.6);
/// assert!((1.0 / pair.stiffness - (1.0 / 2e6 + 1.0 / 1e5)).abs() < 1e-18); // [m/N]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Coefficient of Coulomb friction μ (dimensionless).
    pub friction: f64,
    /// Coefficient of restitution (Newton): speed of separation over speed of approach, 0 to 1.
    pub restitution: f64,
    /// Coefficient of rolling friction `[m]`: the torque is at most this times the normal force.
    pub rolling_friction: f64,
    /// Coefficient of spinning friction `[m]`: the torque about the normal is at most this times the normal force.
    pub spinning_friction: f64,
    /// Stiffness, normal force over penetration `[N/m]`; infinite for a rigid surface.
    pub stiffness: f64,
    /// Dissipation of a compliant contact [s/m]: force k·δ·(1 + dissipation·δ̇).
    pub dissipation: f64,
    /// Collision group: colliders of the same group, other than 0, do not collide with each other.
    pub group: u32,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            friction: 0.0,
            restitution: 0.0,
            rolling_friction: 0.0,
            spinning_friction: 0.0,
            stiffness: f64::INFINITY,
            dissipation: 0.0,
            group: 0,
        }
    }
}

impl Material {
    /// Coefficients in the order of the fields: friction, restitution, rolling and spinning friction `[m]`, stiffness
    /// [N/m], dissipation [s/m].
    #[must_use]
    pub fn coefficients(&self) -> [f64; 6] {
        let Self { friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation, group: _ } =
            *self;
        [friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation]
    }

    /// This material with other [`Material::coefficients`].
    #[must_use]
    pub fn with_coefficients(self, coefficients: [f64; 6]) -> Self {
        let [friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation] = coefficients;
        Self { friction, restitution, rolling_friction, spinning_friction, stiffness, dissipation, ..self }
    }

    /// Contact law of a pair of surfaces: geometric mean of the friction coefficients, sum of the compliances 1/k, the
    /// larger of the two for all else; the group of the result is 0.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            friction: (self.friction * other.friction).sqrt(),
            restitution: self.restitution.max(other.restitution),
            rolling_friction: self.rolling_friction.max(other.rolling_friction),
            spinning_friction: self.spinning_friction.max(other.spinning_friction),
            stiffness: 1.0 / (1.0 / self.stiffness + 1.0 / other.stiffness),
            dissipation: self.dissipation.max(other.dissipation),
            group: 0,
        }
    }
}

/// Contact law of the surfaces of two bodies, in place of the combination of their materials. Fields that are
/// `None` are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairLaw {
    /// True if the two do not collide with each other.
    pub is_excluded: bool,
    /// Coefficient of Coulomb friction μ (dimensionless).
    pub friction: Option<f64>,
    /// Coefficient of restitution, 0 to 1.
    pub restitution: Option<f64>,
    /// Coefficient of rolling friction `[m]`.
    pub rolling_friction: Option<f64>,
    /// Coefficient of spinning friction `[m]`.
    pub spinning_friction: Option<f64>,
    /// Stiffness, normal force over penetration `[N/m]`; infinite for a rigid contact.
    pub stiffness: Option<f64>,
    /// Dissipation of a compliant contact [s/m].
    pub dissipation: Option<f64>,
}

impl PairLaw {
    /// The contact law, from the combination of the two materials.
    pub(crate) fn replace(&self, combined: Material) -> Material {
        Material {
            friction: self.friction.unwrap_or(combined.friction),
            restitution: self.restitution.unwrap_or(combined.restitution),
            rolling_friction: self.rolling_friction.unwrap_or(combined.rolling_friction),
            spinning_friction: self.spinning_friction.unwrap_or(combined.spinning_friction),
            stiffness: self.stiffness.unwrap_or(combined.stiffness),
            dissipation: self.dissipation.unwrap_or(combined.dissipation),
            group: 0,
        }
    }
}
