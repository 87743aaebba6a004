# The resampler's tests.
drumhead_test(NAME kernels_resample_test
              SOURCES kernels_resample_test.cpp
              LINK drumhead::kernels
              LABEL unit)
drumhead_test(NAME kernels_resample_quality_test
              SOURCES kernels_resample_quality_test.cpp
              LINK drumhead::kernels
              LABEL unit)
