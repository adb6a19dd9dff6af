# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Work-precision diagram of one scene: processor time over error, with a curve for each tool.
# gnuplot -c plot.gnuplot POINTS.csv SCENE OUT.png
csv = ARG1
scene = ARG2
set terminal pngcairo size 900,600 font 'sans-serif,12' background 'white'
set encoding utf8
set output ARG3
set datafile separator comma

# Okabe and Ito's colors, which the color-blind can distinguish.
tools = 'radau dopri5 bdf adams'
labels = '"bbsim radau" "odeint dopri5" "CVODE BDF" "CVODE Adams"'
colours = '#0072B2 #D55E00 #009E73 #CC79A7'

set title scene noenhanced
set logscale xy
set format '10^{%L}'
set xlabel 'error: largest |Δx|, |Δy| over the output times (m)'
set ylabel 'processor time of a run (µs)'
set xrange [1e-16:1]
set xtics 1e2
set mxtics 2
set mytics 10
set grid xtics ytics mytics lc rgb '#c0c0c0' lw 1, lc rgb '#ececec' lw 1
set key outside right top
set tics nomirror
set border 3

# Zero has no logarithm. Errors below rounding are drawn at 1e-16.
within(error) = error > 1e-16 ? error : 1e-16
chosen(tool) = stringcolumn(1) eq scene && stringcolumn(2) eq tool
set table $radau
plot csv using (within($5)):6 with table if (chosen('radau'))
set table $dopri5
plot csv using (within($5)):6 with table if (chosen('dopri5'))
set table $bdf
plot csv using (within($5)):6 with table if (chosen('bdf'))
set table $adams
plot csv using (within($5)):6 with table if (chosen('adams'))
unset table

set datafile separator whitespace
plot for [i = 1:4] '$'.word(tools, i) using 1:2 with linespoints lw 2 pt 3 + 2 * i ps 0.8 \
  lc rgb word(colours, i) title word(labels, i)
