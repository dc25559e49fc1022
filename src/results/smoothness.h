#pragma once

#include <vector>

namespace endovascular_sim::results
{

/** Spectral arc length (SPARC), a smoothness measure: negative arc length of the normalised Fourier spectrum of the
 *  speed.
 *
 *  Source: S. Balasubramanian, A. Melendez-Calderon, A. Roby-Brami, E. Burdet, "On the analysis of movement
 *  smoothness", J. NeuroEng. Rehabil. 12:112, 2015, with their cutoff frequency of 10 Hz and amplitude threshold of
 *  0.05.
 *  @param speed uniformly sampled speed [m/s]
 *  @param rate sampling rate [Hz]
 *  @return spectral arc length [1]; values closer to 0 are smoother; 0 without motion */
double spectralArcLength(const std::vector<double>& speed, double rate);

}  // namespace endovascular_sim::results
