# SPDX-License-Identifier: BSD-3-Clause
# A formula with stand-ins for what Homebrew offers to it: formula.rb FORMULA.rb FOLDER
class Formula
  class << self
    attr_reader :said, :check

    def method_missing(name, *words)
      ((@said ||= {})[name] ||= []) << words
    end

    def respond_to_missing?(*)
      true
    end

    def test(&block)
      @check = block
    end
  end

  attr_reader :commands

  def initialize
    @commands = []
  end

  def system(*words)
    @commands << words.map(&:to_s)
  end

  def std_cmake_args
    ["-DCMAKE_INSTALL_PREFIX=/cellar"]
  end

  def bin
    Place.new("/cellar/bin")
  end

  def testpath
    Place.new(ARGV[1])
  end

  def shell_output(command)
    @commands << [command]
    "-I/cellar/include -lse3d\n"
  end
end

# A path.
class Place
  def initialize(path)
    @path = path
  end

  def /(other)
    Place.new("#{@path}/#{other}")
  end

  def to_s
    @path
  end

  def write(text)
    File.write(@path, text)
  end
end

def ENV.cc
  "cc"
end

load ARGV[0]
said = Se3d.said
abort "the formula says #{said}" unless %i[desc url version sha256 license depends_on].all? { |name| said[name] }
abort "sha256 is #{said[:sha256]}" unless said[:sha256][0][0] =~ /\A\h{64}\z/
needs = said[:depends_on].map { |words| words[0].is_a?(Hash) ? words[0].keys[0] : words[0] }
abort "it needs #{needs}" unless (%w[cmake libyaml suite-sparse] - needs).empty?
made = Se3d.new
made.install
expected = [%w[cmake -S], %w[cmake --build], %w[cmake --install]]
abort "it does #{made.commands}" unless made.commands.map { |words| words.first(2) } == expected
made.instance_eval(&Se3d.check)
tried = made.commands.last(2).map { |words| words.first(2) }
abort "it tries #{tried}" unless tried == [%w[/cellar/bin/se3d new], %w[/cellar/bin/se3d run]]
