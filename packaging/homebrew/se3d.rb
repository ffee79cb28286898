# SPDX-License-Identifier: BSD-3-Clause
class Se3d < Formula
  desc "Constrained rigid multibody dynamics in three dimensions"
  url "@URL@"
  version "@VERSION@"
  sha256 "@SHA256@"
  license "BSD-3-Clause"

  depends_on "cmake" => :build
  depends_on "pkgconf" => :test
  depends_on "libyaml"
  depends_on "suite-sparse"
  uses_from_macos "expat"
  uses_from_macos "zlib"

  def install
    system "cmake", "-S", ".", "-B", "build", "-DSE3D_BUILD_TESTS=OFF",
           "-DSE3D_BUILD_EXAMPLES=OFF", "-DSE3D_BUNDLE_VIEWER=OFF", "-DSE3D_LIVE=OFF",
           "-DSE3D_FMU=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    (testpath/"test.c").write <<~C
      #include <se3d/se3d.h>
      int main(void)
      {
          se3d_system *system = NULL;
          const se3d_status status = se3d_system_create(NULL, &system);
          se3d_system_destroy(system);
          return SE3D_FAILED(status);
      }
    C
    flags = shell_output("pkg-config --cflags --libs se3d").chomp.split
    system ENV.cc, "test.c", "-o", "test", *flags
    system "./test"
    system bin/"se3d", "new", "first.yaml"
    system bin/"se3d", "run", "first.yaml"
  end
end
