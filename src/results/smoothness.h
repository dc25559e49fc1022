#pragma once

#include <vector>

namespace endovascular_sim::results
{

/** Smoothness of a movement by the length of its speed's spectrum: SPARC of S. Balasubramanian, A. Melendez-Calderon,
 *  A. Roby-Brami, E. Burdet, "On the analysis of movement smoothness", J. NeuroEng. Rehabil. 12:112, 2015, with their
 *  cut-off of 10 Hz and amplitude threshold of 0.05.
 *  @param speed evenly sampled [m/s]
 *  @param rate of the samples [Hz]
 *  @return dimensionless, negative: the nearer to 0 the smoother; 0 when nothing moved */
double spectralArcLength(const std::vector<double>& speed, double rate);

}  // namespace endovascular_sim::results
