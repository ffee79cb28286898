# SPDX-License-Identifier: BSD-3-Clause
# Haug's spatial slider-crank: slider and crank torque. Run by make.sh with `folder` set.
set terminal svg size 760,280 font "sans-serif,12" background rgb "white"
set datafile separator ","
set grid lc rgb "#dddddd"
set xlabel "time [s]"
set key inside top right samplen 1.5
set style data lines
set lmargin 10
file = folder."/spatial_slider_crank.csv"
set multiplot layout 1,2
set ylabel "slider [m], [m/s]"
set yrange [-0.5:0.8]
plot file using "time":"slider.position.x" lw 2 lc rgb "#2471a3" title "position", \
     file using "time":"slider.velocity.x" lw 2 lc rgb "#117a65" title "velocity"
set ylabel "torque [N m]"
set yrange [-0.4:0.5]
plot file using "time":"motor.effort" lw 2 lc rgb "#c0392b" title "crank torque"
unset multiplot
