#!/usr/bin/env bash
# Submits a picture of many dots to Slurm: a survey, an array of parts, and a merge. See docs/farm.md.
#
#     submit.sh PHOTO DOTS PARTS FOLDER [TONE OPTIONS...]
#
# The environment may set PROGRAM (twelvefold), FORMAT (csv, svg or npy), OPTIONS (of the parts only, such as
# "--seed 3"), and what sbatch reads itself: SBATCH_PARTITION, SBATCH_ACCOUNT and so on. PHOTO, FOLDER and PROGRAM
# have to be the same on all nodes.
#
# Submitted again, it makes only what is missing.
set -euo pipefail
if (($# < 4)); then
    sed -n 's/^#     //p' "$0" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
photo=$(realpath "$1") dots=$2 parts=$3
tone=("${@:5}")
mkdir -p "$4/log"
folder=$(cd "$4" && pwd)
program=${PROGRAM:-twelvefold} format=${FORMAT:-csv} options=${OPTIONS:-}

# Parts of another picture or other options are not to be taken for this one's.
settings="$(cksum <"$photo") $dots $parts $format $options ${tone[*]}"
if [[ -e $folder/settings ]] && [[ $(<"$folder/settings") != "$settings" ]]; then
    echo "$folder holds parts of another picture or with other options; choose another folder" >&2
    exit 1
fi
printf '%s\n' "$settings" >"$folder/settings.$$"
mv "$folder/settings.$$" "$folder/settings"

missing=$(for ((part = 1; part <= parts; part++)); do
    printf -v name '%s/part-%05d.%s' "$folder" "$part" "$format"
    [[ -e $name ]] || echo "$part"
done | paste -sd ,)

# Submits a step after the job `after`, if any, and prints its number. What waits for a step that failed for good is
# taken off the queue.
after=
submit() {
    local step=$1
    shift
    sbatch --parsable --kill-on-invalid-dep=yes ${after:+"--dependency=afterok:$after"} "$@" \
        "$here/slurm.sh" "$step" "$photo" "$dots" "$parts" "$folder" "$program" "$format" "$options" "${tone[@]}"
}

if [[ -n $missing ]]; then
    if ! [[ -e $folder/photo.survey ]]; then
        after=$(submit survey --job-name=survey --output="$folder/log/survey-%j")
    fi
    after=$(submit part --job-name=parts --array="$missing" --output="$folder/log/part-%a-%A")
fi
merge=$(submit merge --job-name=merge --output="$folder/log/merge-%j")
echo "job $merge makes $folder/dots.$format"
