# SPDX-License-Identifier: GPL-3.0-or-later
# Points of the paths of an SVG of curves, in the units of its axes, which are read off the marks: for each path a line that
# begins with its colour and its kind: solid, dashed, marker (a path of one point) or bars (in pieces).
local $/;
$_ = <STDIN>;
my (@x, @y, @xt, @yt);
push @x, $1 + 0.8 while /<rect x="([\d.]+)" y="[\d.]+" width="1.6" height="9"/g;
push @y, $1 + 0.8 while /<rect x="[\d.]+" y="([\d.]+)" width="9" height="1.6"/g;
push @xt, $1 while /text-anchor="middle" fill="#222222">((?:−)?[\d.]+)</g;
push @yt, $1 while /text-anchor="end" fill="#222222">((?:−)?[\d.]+)</g;
s/−/-/ for @xt, @yt;
die "marks" if @x < 2 || @y < 2 || @x != @xt || @y != @yt;
sub value { my ($p, $at, $text) = @_; $$text[0] + ($p - $$at[0]) / ($$at[-1] - $$at[0]) * ($$text[-1] - $$text[0]) }
my $bottom = /<clipPath id="\w+"><rect x="[\d.]+" y="([\d.]+)" width="[\d.]+" height="([\d.]+)"/ ? $1 + $2 : die "plot";
while (/<path d="([^"]*)" fill="none" ([^>]*)>/g) {
    my ($path, $how) = ($1, $2);
    my @p = map { [split] } $path =~ /[ML]([\d.]+ [\d.]+)/g;
    next if $p[0][1] > $bottom + 1; # the legend
    my ($colour) = $how =~ /stroke="(#\w+)"/;
    my $twice = @p > 1 && "@{$p[0]}" eq "@{$p[1]}"; # where the pen comes down
    my $kind = $how =~ /stroke-dasharray/ ? "dashed" : @p == 2 && $twice ? "marker" : $twice ? "solid" : "bars";
    my $last = ""; # and again behind each gap
    @p = grep { my $same = "@$_" eq $last; $last = "@$_"; !$same } @p if $twice;
    printf "%s %s", $colour, $kind;
    printf " %.9g %.9g", value($$_[0], \@x, \@xt), value($$_[1], \@y, \@yt) for @p;
    print "\n";
}
