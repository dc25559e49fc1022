#pragma once

// Function multiversioning: an additional AVX2 version is selected at run time. Results are bitwise equal, because no
// multiply-add is fused. Sanitizers have one version: their runtime is not ready when the loader selects one.
#if defined(__x86_64__) && !defined(ENDOVASCULAR_SANITIZED)
#define EVS_WIDE_VECTORS [[gnu::target_clones("avx2", "default")]]
#else
#define EVS_WIDE_VECTORS
#endif
