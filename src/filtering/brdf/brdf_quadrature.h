#pragma once

#include "domelight/filtering/brdf/brdf_table.h"

namespace domelight {

/// The split sum's second factor for one pair: specular reflectance under a constant white environment is F0 scale +
/// bias.
struct BrdfTerms {
    double scale = 0, bias = 0;
};

/// Nodes of the quadrature: azimuth, and polar ones in each of the two pieces.
struct BrdfNodes {
    int azimuth = 16, polar = 32;
};

/// ∫ f NdotL dl without and with Schlick's Fc = (1 - VdotH)^5 split off, f = D G2 / (4 NdotL NdotV), GGX.
///
/// NdotV in (0, 1], alpha in (0, 1]. By Gauss-Legendre over the half vector. With tan theta_h = alpha tan z the
/// distribution is gone,
///   D NdotH dh = (1 / pi) sin z cos z dz dphi,  ∫ f (...) NdotL dl = ∫ 4 V NdotL VdotH / NdotH (...) D NdotH dh,
/// and where NdotL > 0 ends is cut off: all azimuths for theta_h < (pi/2 - theta_v) / 2, none from (pi/2 + theta_v) / 2
/// on, between the two those with cos phi > (c_v / 2 c_h - c_v c_h) / (s_v s_h). At these two angles the azimuth's
/// range begins and ends with a vertical tangent, which the substitution z = za + (zb - za) x^2 (3 - 2x) in each piece
/// removes.
BrdfTerms integrate_brdf(double NdotV, double alpha, BrdfG g, BrdfNodes nodes = {});

/// G2 / (4 NdotL NdotV): the visibility term. Cosines positive.
double brdf_visibility(double NdotL, double NdotV, double alpha, BrdfG g);

/// Directional albedo of the sheen lobe, ∫ D V NdotL dl, as Khronos's glTF-IBL-Sampler defines its third channel:
/// D_Charlie (Estevez and Kulla 2017) of alpha = roughness^2, V = 1 / (4 (NdotL + NdotV - NdotL NdotV)) (Neubelt and
/// Pettineo 2013). The integral is over the light direction, with nodes spaced logarithmically towards the horizon and
/// towards the mirror azimuth, where the integrand varies on the scale of NdotV.
double integrate_sheen(double NdotV, double alpha, int nodes = 32);

/// The table of size x size of these integrals, as brdf_table() describes it. sheen: or 0 in the third channel.
ImageF integrate_brdf_table(int size, BrdfG g, bool sheen, int threads);

}  // namespace domelight
