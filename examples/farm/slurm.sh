#!/usr/bin/env bash
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
# One step of a picture of many dots, as submit.sh submits it: survey, part (an element of an array) or merge.
#
# A file is there when it is whole: the program writes beside its name and renames. So a step may be killed at any
# moment and run again. Slurm puts it back on the queue when its node fails or is taken away (--requeue); this
# script does when the program fails or is killed, as for want of memory, three times.
set -euo pipefail
step=$1 photo=$2 dots=$3 parts=$4 folder=$5 program=$6 format=$7
read -ra options <<<"$8"
tone=("${@:9}")
part=${SLURM_ARRAY_TASK_ID:-1}

again() {
    local job=$SLURM_JOB_ID
    [[ -z ${SLURM_ARRAY_JOB_ID:-} ]] || job=${SLURM_ARRAY_JOB_ID}_$part
    if ((${SLURM_RESTART_COUNT:-0} < 3)); then
        echo "$step: once more" >&2
        scontrol requeue "$job"
    fi
    exit 1
}

case $step in
survey)
    "$program" survey "$photo" "${tone[@]}" -o "$folder/photo.survey" || again
    ;;
part)
    printf -v out '%s/part-%05d.%s' "$folder" "$part" "$format"
    [[ -e $out ]] && exit
    "$program" stipple "$photo" -n "$dots" --refine 0 --part "$part/$parts" --survey "$folder/photo.survey" \
        "${tone[@]}" "${options[@]}" -o "$out" || again
    ;;
merge)
    names=()
    for ((part = 1; part <= parts; part++)); do
        printf -v name '%s/part-%05d.%s' "$folder" "$part" "$format"
        names+=("$name")
    done
    "$program" merge "${names[@]}" -o "$folder/dots.$format" || again
    ;;
esac
