# SPDX-License-Identifier: BSD-3-Clause
# The scripts of examples/study, three parts on this machine. Scripts take the places of hq and parallel and do what
# those would do: one task after the other.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
source=$(cd "$source" && pwd)
unset SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_MIN SLURM_ARRAY_TASK_COUNT PBS_ARRAY_INDEX PBS_ARRAYID HQ_TASK_ID
cp "$source/examples/study/"* "$dir"
cd "$dir" || exit 1
export SE3D="$program"
expect 'the whole' 0 "$program" study damper.yaml -o whole -q
whole=$(cksum <whole/study.csv)

mkdir bin
cat >bin/hq <<'END_OF_SCRIPT'
#!/bin/sh
[ "$1 $2 $3 $5" = 'submit --wait --array --cpus' ] || exit 2
last=${4#1-}
shift 6
for task in $(seq "$last"); do
    HQ_TASK_ID=$task "$@" || exit 1
done
END_OF_SCRIPT
cat >bin/parallel <<'END_OF_SCRIPT'
#!/bin/sh
while read -r line; do
    sh -c "$(printf '%s\n' "$*" | sed "s/{}/$line/g")" || exit 1
done
END_OF_SCRIPT
chmod +x bin/hq bin/parallel
PATH=$dir/bin:$PATH

parts=$(sed -n 's/^#SBATCH --array=1-//p' slurm.sh)
is "$parts" 3
for task in $(seq "$parts"); do
    expect "task $task" 0 env RESULTS=slurm SLURM_ARRAY_TASK_ID="$task" SLURM_ARRAY_TASK_MIN=1 \
        SLURM_ARRAY_TASK_COUNT="$parts" sh slurm.sh
done
expect 'its parts' 0 "$program" study damper.yaml -o slurm --merge
is "$(cksum <slurm/study.csv)" "$whole"
for tool in hyperqueue parallel; do
    expect "$tool" 0 env RESULTS=$tool sh $tool.sh 3
    is "$(find $tool -name 'study.*-of-3.csv' | wc -l)" 3
    is "$(cksum <$tool/study.csv)" "$whole"
done

# What Dakota writes for its variables and responses.
ask() {
    printf '%s\n' '                                          2 variables' "                      $1 k" \
        '                      1.200000000000000e+01 c' '                                          2 functions' \
        '                                          1 ASV_1:ratio' '                                          1 ASV_2:settled' \
        '                                          2 derivative_variables' '                                          1 DVV_1:k' \
        '                                          2 DVV_2:c' '                                          0 analysis_components' \
        '                                          1 eval_id' >params.in
}
ask 8.000000000000000e+02
expect 'Dakota' 0 sh dakota.sh params.in results.out
is "$(awk '{ printf "%s %.6f,", $2, $1 }' results.out)" 'ratio 0.620715,settled 1.293325,'
ask -8.0e+02
expect 'a run that fails' 0 sh dakota.sh params.in results.out
is "$(cat results.out)" FAIL
says '"error": "`settled` has not settled at the end"'
for word in descriptors analysis_drivers parameters_file results_file; do
    has dakota.in "$word"
done
finish
