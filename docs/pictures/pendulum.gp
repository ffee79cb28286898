# SPDX-License-Identifier: BSD-3-Clause
# The driven pendulum: motor torque and pin force. Run by make.sh with `folder` set.
set terminal svg size 760,280 font "sans-serif,12" background rgb "white"
set datafile separator ","
set grid lc rgb "#dddddd"
set xlabel "time [s]"
set key inside top right samplen 1.5
set style data lines
set lmargin 10
file = folder."/pendulum.csv"
set multiplot layout 1,2
set ylabel "torque [N m]"
set yrange [-300:400]
plot file using "time":"drive.effort" every 4 lw 2 lc rgb "#c0392b" title "motor torque"
set ylabel "force [N]"
set yrange [-500:2000]
plot file using "time":"pin.force.y" every 4 lw 2 lc rgb "#2471a3" title "pin force, y", \
     file using "time":"pin.force.z" every 4 lw 2 lc rgb "#117a65" title "pin force, z"
unset multiplot
